// edit_keys.js: The keys of the editor, which are those of the window's editor. They work while a
// panel of the editor is shown, before the page's own keys.
"use strict";

import { make } from "./fields.js";

const $ = (id) => document.getElementById(id);

export class EditorKeys {
  constructor(editor) {
    this.editor = editor;
    this.keys = this.table();
    for (const kind of ["keydown", "keyup"])
      window.addEventListener(kind, (event) => this[kind](event), { capture: true });
  }

  // The keys of the editor, as in the window: keys, what they do for the help, and the action.
  // Those with Ctrl also count where text is typed, the others belong to the text there.
  table() {
    const edit = (command, members) => () => this.editor.edit(command, members);
    const place = () => this.editor.pointer ?? { x: 0.5, y: 0 };
    const tool = (kind) => () => this.editor.tools.begin(kind, place());
    return [
      ["Ctrl+Z", "undo", edit("undo")],
      ["Ctrl+Y Ctrl+Shift+Z", "redo", edit("redo")],
      ["Ctrl+S", "save the file in place", edit("save")],
      ["G", "move what is selected; then X Y Z, numbers, Ctrl, Enter, Escape", tool("move")],
      ["R", "turn it", tool("turn")],
      ["S", "scale it", tool("scale")],
      ["T", "handles that move, turn, scale, or none", edit("handles")],
      ["Shift+D", "duplicate what is selected", edit("duplicate")],
      ["Ctrl+G", "put a Transform around what is selected", edit("wrap")],
      ["X Delete", "remove what is selected", edit("remove")],
      [".", "go to what is selected", edit("frame")],
      ["V", "probe of luminance at the pointer", () => this.putProbe(false)],
      ["U", "probe of illuminance at the pointer", () => this.putProbe(true)],
      ["Shift+V", "measure a rectangle", () => this.editor.tools.measure()],
      ["B", "keep the picture and the light as A", edit("keep_probes")],
      ["\\", "A in the place of the picture", edit("compare", { what: "a" })],
      ["W", "A beside the picture", edit("compare", { what: "wiper" })],
      ["D", "what has changed since A", edit("compare", { what: "difference" })],
      ["F1", "this help", () => this.showHelp()],
      ["Escape", "give up a report, end a comparison, select nothing", () => this.escape()],
    ].map(([keys, text, action]) => ({ keys: keys.split(" "), text, action }));
  }

  nameOf(event) {
    if (event.key === "\\") return event.key; // it needs other keys on some keyboards
    const key = event.key.length === 1 ? event.key.toUpperCase() : event.key;
    return `${event.ctrlKey ? "Ctrl+" : ""}${event.shiftKey ? "Shift+" : ""}${key}`;
  }

  keydown(event) {
    if (!this.editor.isOpen() || document.querySelector("dialog[open]") || event.metaKey) return;
    if (this.editor.tools.takeKey(event)) return this.consume(event);
    if (event.altKey && event.key !== "\\") return;
    const isTyped = /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName ?? "");
    const name = this.nameOf(event);
    const found = this.keys.find(({ keys }) => keys.includes(name));
    if (!found || (isTyped && (!name.startsWith("Ctrl+") || name === "Ctrl+G"))) return;
    if (name === "Escape" && this.endsNothing()) return; // the page's own Escape
    this.consume(event);
    if (isTyped) event.target.blur(); // what was typed counts before
    if (!event.repeat || name === "Ctrl+Z" || name === "Ctrl+Y") found.action();
  }

  keyup(event) {
    const isSnap = this.editor.isOpen() && event.key === "Control";
    if (isSnap && this.editor.tools.takeKey(event)) this.consume(event);
  }

  consume(event) {
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  endsNothing() {
    if (this.editor.isReporting) return false;
    return this.editor.selected === 0 && this.editor.light.state.shown === "present";
  }

  escape() {
    const { shown } = this.editor.light.state;
    if (this.editor.isReporting) this.editor.edit("report"); // once more gives it up
    else if (shown === "present") this.editor.edit("select", { node: null });
    else this.editor.edit("compare", { what: shown });
  }

  // Without a pointer over the picture, the keyboard measures in its middle.
  putProbe(illuminance) {
    const middle = document.activeElement === $("picture") ? { x: 0, y: 0 } : null;
    const at = this.editor.pointer ?? middle;
    if (!at || Math.max(Math.abs(at.x), Math.abs(at.y)) > 1)
      return this.editor.say("put the pointer where the light is to be measured", true);
    this.editor.edit("probe", { x: at.x, y: at.y, illuminance });
  }

  showHelp() {
    Object.getPrototypeOf(window.page).showHelp.call(window.page);
    if (!this.editor.isOpen()) return;
    const table = make("table");
    for (const { keys, text } of this.keys) {
      const row = table.insertRow();
      row.insertCell().textContent = keys.join(", ");
      row.insertCell().textContent = text;
    }
    $("content").prepend(make("h2", { textContent: "Editor" }), table);
  }
}
