// reports.js: The messages about the world as a list, which leads to their nodes, and reports.
"use strict";

import { make } from "./fields.js";

export class Problems {
  // edit: sends a command of the editor.
  constructor(section, button, edit) {
    Object.assign(this, { section, button, edit });
    this.shown = ""; // the message that is shown in full
    this.isOpen = false;
    button.addEventListener("click", () => edit("problems", { open: !this.isOpen }));
  }

  onProblems(message) {
    const text = JSON.stringify(message);
    if (text === this.text) return;
    this.text = text;
    this.message = message;
    this.draw();
  }

  draw() {
    const { open, count, rows, dropped } = this.message;
    this.isOpen = open;
    this.button.textContent = `Problems (${count})`;
    this.button.disabled = count === 0 && !open;
    this.button.setAttribute("aria-expanded", open);
    this.section.hidden = !open;
    const focused = [...this.section.querySelectorAll("button")].indexOf(document.activeElement);
    const items = rows.map((row) => this.row(row));
    if (dropped > 0) items.push(make("li", { textContent: `and ${dropped} more` }));
    if (rows.length === 0) items.push(make("li", { textContent: "There are none." }));
    this.section.querySelector("ul").replaceChildren(...items);
    if (focused >= 0) [...this.section.querySelectorAll("button")].at(focused)?.focus();
  }

  // A click shows a message in full, and selects the node that it is about.
  row(row) {
    const isShown = row.text === this.shown;
    const button = make("button", { type: "button", textContent: row.text.split("\n")[0] });
    button.title = row.label ? `Select ${row.label}` : "Show it in full";
    button.setAttribute("aria-expanded", isShown);
    button.addEventListener("click", () => {
      this.shown = isShown ? "" : row.text;
      this.draw();
      if (!isShown && row.node !== undefined) this.edit("select", { node: row.node });
    });
    const item = make("li", { className: row.severity }, button);
    if (!isShown) return item;
    const lines = [row.text, row.label ?? "", row.line].filter((line) => line);
    item.append(make("pre", { textContent: lines.join("\n") }));
    return item;
  }
}

// Returns what a page shows of a report: links to its files, which are kept for a minute.
export function reportPanel(message) {
  const links = message.files.map(({ path, name }) => {
    const link = make("a", { href: path, download: name, textContent: name });
    return make("li", {}, link);
  });
  return make(
    "div",
    { id: "report-files" },
    make("p", { textContent: "The report is ready. Download its files within a minute:" }),
    make("ul", {}, ...links),
  );
}
