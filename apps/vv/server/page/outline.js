// outline.js: The outline of the editor: the nodes of the world as a tree, of which vv sends only
// the rows that are to be seen. Names are those of a file, which may be hostile: they are set as
// text.
"use strict";

// Pixels; edit.css has the same. Rows are as high as the texts that the user has chosen need.
const rowHeight = Math.round(
  1.5714 * parseFloat(getComputedStyle(document.documentElement).fontSize),
);
document.documentElement.style.setProperty("--row", `${rowHeight}px`);
const spare = 10; // rows above and below those that are seen
const mostHeight = 8e6; // pixels; browsers cut off higher elements

export class Outline {
  // list: the element that scrolls. edit: sends a command of the editor. openMenu: lists what can
  // be done with a row, beside an element.
  constructor(list, edit, openMenu) {
    this.list = list;
    this.edit = edit;
    this.openMenu = openMenu;
    this.rows = [];
    this.first = 0; // number of the first of these rows
    this.total = 0;
    this.cursor = 0; // the row that keys work on
    this.wanted = null; // a row that is to be seen once the rows have come
    this.most = 500;
    this.extent = document.createElement("div");
    this.extent.className = "extent";
    this.shown = document.createElement("div");
    this.shown.className = "shown";
    this.extent.append(this.shown);
    list.replaceChildren(this.extent);
    list.setAttribute("role", "tree");
    list.setAttribute("aria-multiselectable", "true");
    list.tabIndex = 0;
    list.addEventListener("scroll", () => this.ask());
    list.addEventListener("keydown", (event) => this.keydown(event));
    list.addEventListener("click", (event) => this.click(event));
    list.addEventListener("contextmenu", (event) => this.menu(event));
    new ResizeObserver(() => this.ask()).observe(list);
  }

  get height() {
    return Math.min(this.total * rowHeight, mostHeight);
  }

  // Rows for each row's height that the list is scrolled: more than one in huge worlds.
  get scale() {
    return this.height > 0 ? (this.total * rowHeight) / this.height : 1;
  }

  get firstSeen() {
    return Math.floor((this.list.scrollTop * this.scale) / rowHeight);
  }

  get countSeen() {
    return Math.max(1, Math.floor(this.list.clientHeight / rowHeight));
  }

  // Asks for the rows that are to be seen, if they are others than before.
  ask(again = false) {
    if (!again && this.list.clientHeight === 0) return; // it is hidden
    const count = Math.min(this.countSeen + 2 * spare, this.most);
    const first = Math.max(0, this.firstSeen - spare);
    const wanted = `${first} ${count}`;
    const isNew = again || wanted !== this.asked;
    this.asked = wanted;
    if (isNew) this.edit("rows", { first, count });
    this.place();
  }

  // Puts the rows where they are seen.
  place() {
    const scrolled = this.list.scrollTop;
    const top = scrolled + this.first * rowHeight - scrolled * this.scale;
    this.shown.style.transform = `translateY(${top}px)`;
  }

  show(message) {
    this.rows = message.rows;
    this.first = message.first;
    this.total = message.total;
    this.cursor = Math.max(0, Math.min(this.cursor, this.total - 1));
    this.extent.style.height = `${this.height}px`;
    this.shown.replaceChildren(...this.rows.map((row, i) => this.element(row, this.first + i)));
    this.mark();
    const wanted = this.wanted;
    this.wanted = null;
    if (wanted !== null) this.goTo(wanted);
    this.ask();
  }

  element(row, number) {
    const item = document.createElement("div");
    item.id = `row-${number}`;
    item.className = "row";
    item.dataset.number = number;
    item.setAttribute("role", "treeitem");
    item.setAttribute("aria-level", row.depth + 1);
    item.setAttribute("aria-selected", row.selected === true);
    if ("open" in row) item.setAttribute("aria-expanded", row.open);
    item.classList.toggle("use", row.use === true);
    item.style.paddingLeft = `${4 + row.depth * 12}px`;
    const sign = document.createElement("span");
    sign.className = "sign";
    sign.textContent = "open" in row ? (row.open ? "\u25be" : "\u25b8") : "";
    const label = document.createElement("span");
    label.className = "label";
    label.textContent = (row.use ? "USE " : "") + row.label;
    item.append(sign, label);
    return item;
  }

  row(number) {
    return this.rows[number - this.first];
  }

  // Shows which row the keys work on.
  mark() {
    this.shown.querySelector(".cursor")?.classList.remove("cursor");
    const item = document.getElementById(`row-${this.cursor}`);
    item?.classList.add("cursor");
    if (item) this.list.setAttribute("aria-activedescendant", item.id);
    else this.list.removeAttribute("aria-activedescendant");
  }

  // Shows a row that has been selected. Its rows may still be on their way.
  reveal(number) {
    this.wanted = number;
    this.goTo(number);
  }

  // Puts the cursor on a row, and scrolls if it is not seen.
  goTo(number) {
    this.cursor = number;
    const first = this.firstSeen;
    if (number < first || number >= first + this.countSeen)
      this.list.scrollTop = (Math.max(0, number - 3) * rowHeight) / this.scale;
    this.mark();
    this.ask();
  }

  // The parent's row may not have come: then the key does nothing.
  goToParent() {
    const depth = this.row(this.cursor)?.depth ?? 0;
    const before = this.rows.slice(0, Math.max(0, this.cursor - this.first));
    const place = before.findLastIndex((one) => one.depth < depth);
    if (place >= 0) this.goTo(this.first + place);
  }

  open(row, open) {
    if (row && "open" in row && row.open !== open) this.edit("open", { node: row.node, open });
  }

  select(row, add) {
    if (row) this.edit("select", { node: row.node, add });
  }

  click(event) {
    const item = event.target.closest(".row");
    if (!item) return;
    this.cursor = Number(item.dataset.number);
    this.mark();
    const row = this.row(this.cursor);
    if (event.target.className === "sign" && row && "open" in row) this.open(row, !row.open);
    else this.select(row, event.shiftKey || event.ctrlKey);
  }

  // Lists the commands of the row under the pointer, or by key of the one with the cursor.
  menu(event) {
    event.preventDefault();
    const item = event.target.closest(".row") ?? document.getElementById(`row-${this.cursor}`);
    const row = item && this.row(Number(item.dataset.number));
    if (!row) return;
    this.cursor = Number(item.dataset.number);
    this.mark();
    if (!row.selected) this.select(row, false);
    this.openMenu(row, item);
  }

  keydown(event) {
    const row = this.row(this.cursor);
    const add = event.shiftKey || event.ctrlKey;
    const actions = {
      ArrowUp: () => this.goTo(Math.max(0, this.cursor - 1)),
      ArrowDown: () => this.goTo(Math.min(this.total - 1, this.cursor + 1)),
      PageUp: () => this.goTo(Math.max(0, this.cursor - this.countSeen)),
      PageDown: () => this.goTo(Math.min(this.total - 1, this.cursor + this.countSeen)),
      Home: () => this.goTo(0),
      End: () => this.goTo(Math.max(0, this.total - 1)),
      ArrowRight: () => this.open(row, true),
      ArrowLeft: () => (row?.open ? this.open(row, false) : this.goToParent()),
      Enter: () => this.select(row, add),
      " ": () => this.select(row, add),
    };
    if (!actions[event.key] || event.altKey) return;
    event.preventDefault();
    actions[event.key]();
  }
}
