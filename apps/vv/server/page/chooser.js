// chooser.js: A list to choose from, which a text filters: what may be added, looks, commands for a
// row. It is worked by mouse and by keys: arrows, Enter for the row that is marked, Escape.
"use strict";

import { make } from "./fields.js";

const mostShown = 300; // rows; further ones are found by their text

export class Chooser {
  constructor() {
    this.filter = make("input", { type: "search", maxLength: 64 });
    this.list = make("ul", { id: "chooser-list" });
    this.extra = make("div");
    this.dialog = make("dialog", { className: "chooser" }, this.filter, this.extra, this.list);
    this.list.setAttribute("role", "listbox");
    this.filter.setAttribute("role", "combobox");
    this.filter.setAttribute("aria-expanded", "true");
    this.filter.setAttribute("aria-controls", this.list.id);
    document.body.append(this.dialog);
    this.filter.addEventListener("input", () => this.show());
    this.dialog.addEventListener("keydown", (event) => this.keydown(event));
    this.dialog.addEventListener("keyup", (event) => event.stopPropagation());
    this.dialog.addEventListener("pointerdown", (event) => {
      if (event.target === this.dialog && !this.isInside(event)) this.dialog.close();
    });
    this.dialog.addEventListener("close", () => this.ended());
    this.list.addEventListener("click", (event) => {
      const item = event.target.closest("li");
      if (item) this.choose(Number(item.dataset.number));
    });
  }

  // items: objects with label, action, and perhaps text (what it is), note (a word about it) and
  // image (the path of a picture). anchor: the element beside which the list opens. extra: elements
  // above the list.
  open(title, items, anchor, ...extra) {
    this.ended();
    this.items = items;
    this.filter.value = "";
    this.filter.placeholder = title;
    this.filter.setAttribute("aria-label", title);
    this.dialog.setAttribute("aria-label", title);
    this.extra.replaceChildren(...extra);
    this.show();
    if (!this.dialog.open) this.dialog.showModal();
    this.placeAt(anchor);
    this.filter.focus();
  }

  // The items are others now, or have other pictures. What the user has typed and marked stays.
  refresh(items) {
    const marked = this.items[this.list.children[this.place]?.dataset.number]?.label;
    const scrolled = this.list.scrollTop;
    this.items = items;
    this.show();
    const rows = [...this.list.children];
    const place = rows.findIndex((row) => items[row.dataset.number].label === marked);
    this.mark(place);
    this.list.scrollTop = scrolled;
  }

  // The list closes, or shows something else. onClose is called once.
  ended() {
    const { onClose } = this;
    this.onClose = null;
    onClose?.();
  }

  // Opens below an element, or above it where there is no room.
  placeAt(anchor) {
    const at = anchor.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = this.dialog;
    const below = at.bottom + height <= window.innerHeight ? at.bottom : at.top - height;
    const left = Math.max(4, Math.min(at.left, window.innerWidth - width - 4));
    this.dialog.style.left = `${left}px`;
    this.dialog.style.top = `${Math.max(4, Math.min(below, window.innerHeight - height - 4))}px`;
  }

  isInside(event) {
    const area = this.dialog.getBoundingClientRect();
    const isAcross = event.clientX >= area.left && event.clientX <= area.right;
    return isAcross && event.clientY >= area.top && event.clientY <= area.bottom;
  }

  show() {
    const part = this.filter.value.toLowerCase();
    const found = this.items.map((item, number) => ({ item, number }));
    const shown = found.filter(({ item }) => item.label.toLowerCase().includes(part));
    this.list.replaceChildren(
      ...shown.slice(0, mostShown).map(({ item, number }) => {
        const row = make("li", { title: item.text ?? "" });
        if ("image" in item) row.append(this.pictureOf(item));
        row.append(make("span", { textContent: item.label }));
        if (item.note) row.append(make("small", { textContent: item.note }));
        row.id = `choice-${number}`;
        row.dataset.number = number;
        row.setAttribute("role", "option");
        return row;
      }),
    );
    this.mark(0);
  }

  // Returns the picture of an item, or its place while there is none.
  pictureOf(item) {
    if (!item.image) return make("span", { className: "ball" });
    return make("img", { className: "ball", src: item.image, alt: "" }); // the label says it
  }

  // Marks the row that Enter chooses.
  mark(place) {
    const rows = [...this.list.children];
    this.place = Math.max(0, Math.min(place, rows.length - 1));
    rows.forEach((row, i) => row.setAttribute("aria-selected", i === this.place));
    const row = rows[this.place];
    if (row) this.filter.setAttribute("aria-activedescendant", row.id);
    else this.filter.removeAttribute("aria-activedescendant");
    row?.scrollIntoView({ block: "nearest" });
  }

  choose(number) {
    this.dialog.close();
    this.items[number]?.action();
  }

  keydown(event) {
    event.stopPropagation();
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      this.mark(this.place + (event.key === "ArrowDown" ? 1 : -1));
      event.preventDefault();
    } else if (event.key === "Enter" && event.target === this.filter) {
      event.preventDefault();
      const row = this.list.children[this.place];
      if (row) this.choose(Number(row.dataset.number));
    }
  }
}
