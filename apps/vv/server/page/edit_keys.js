// edit_keys.js: The keys of the editor. They work while a panel of the editor is shown, before the
// page's own keys.
"use strict";

import { make } from "./fields.js";

const $ = (id) => document.getElementById(id);

export class EditorKeys {
  constructor(editor) {
    this.editor = editor;
    this.keys = this.table();
    this.rows = []; // what vv says of keys and mouse
    for (const kind of ["keydown", "keyup"])
      window.addEventListener(kind, (event) => this[kind](event), { capture: true });
  }

  // The keys of the editor, which are those of the window's: vv sends what each does, for the help.
  // Those with Ctrl also count where text is typed, the others belong to the text there.
  table() {
    const edit = (command, members) => () => this.editor.edit(command, members);
    const place = () => this.editor.pointer ?? { x: 0.5, y: 0 };
    const tool = (kind) => () => this.editor.tools.begin(kind, place());
    return [
      ["F2", () => $("rename").select()],
      ["Ctrl+Z", edit("undo")],
      ["Ctrl+Y Ctrl+Shift+Z", edit("redo")],
      ["Ctrl+S", edit("save")],
      ["G", tool("move")],
      ["R", tool("turn")],
      ["S", tool("scale")],
      ["T", edit("handles")],
      ["Shift+A", () => this.editor.openKinds()],
      ["Shift+D", edit("duplicate")],
      ["Ctrl+G", edit("wrap")],
      ["X Delete", edit("remove")],
      [".", edit("frame")],
      ["V", () => this.putProbe(false)],
      ["U", () => this.putProbe(true)],
      ["Shift+V", () => this.editor.tools.measure()],
      ["B", edit("keep_probes")],
      ["\\", edit("compare", { what: "a" })],
      ["W", edit("compare", { what: "wiper" })],
      ["D", edit("compare", { what: "difference" })],
      ["F1 ?", () => this.showHelp()],
      ["E", () => this.editor.setOpen(false)],
      ["Escape", () => this.escape()],
    ].map(([keys, action]) => ({ keys: keys.split(" "), action }));
  }

  // Shift belongs to the name of letters and of keys that type nothing: "?" is "?" with whatever
  // keys it is typed.
  nameOf(event) {
    if (event.key === "\\") return event.key; // it needs Ctrl and Alt on some keyboards
    const isCharacter = event.key.length === 1;
    const hasShift = event.shiftKey && (!isCharacter || /[a-z]/i.test(event.key));
    const key = isCharacter ? event.key.toUpperCase() : event.key;
    return `${event.ctrlKey ? "Ctrl+" : ""}${hasShift ? "Shift+" : ""}${key}`;
  }

  // With closed panels E opens them, where the world does not get what is typed.
  opens(event) {
    const mayOpen = this.editor.mayEdit && !this.editor.isOpen() && !window.page.state.keys;
    const isTyped = event.target instanceof HTMLSelectElement;
    return mayOpen && !isTyped && this.nameOf(event) === "E" && !event.altKey && !event.metaKey;
  }

  keydown(event) {
    if (document.querySelector("dialog[open]")) return;
    if (this.opens(event)) {
      this.consume(event);
      return this.editor.setOpen(true);
    }
    if (!this.editor.isOpen() || event.metaKey) return;
    if (this.editor.tools.takeKey(event)) return this.consume(event);
    if (event.altKey && event.key !== "\\") return;
    const isTyped = /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName ?? "");
    const name = this.nameOf(event);
    const found = this.keys.find(({ keys }) => keys.includes(name));
    if (!found || (isTyped && (!name.startsWith("Ctrl+") || name === "Ctrl+G"))) return;
    if (name === "Escape" && this.endsNothing()) return this.editor.setOpen(false); // page.js, too
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
    for (const [what, text] of this.rows) {
      const row = table.insertRow();
      row.insertCell().textContent = what;
      row.insertCell().textContent = text;
    }
    $("content").prepend(make("h2", { textContent: "Editor" }), table);
  }
}
