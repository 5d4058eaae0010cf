// edit.js: The editor on the page of `vv serve --edit`, for those who have opened its second
// address: the outline at the left, the fields of the selected node at the right, and clicks on the
// picture that select. docs/serve.md lists the messages. It works on top of page.js.
"use strict";

import "./page.js";
import { Fields, make } from "./fields.js";
import { Outline } from "./outline.js";

const $ = (id) => document.getElementById(id);
const page = window.page;

// How far the pointer may move between press and release of a click, as a part of the picture.
const clickDistance = 0.012;
const saidSeconds = 6;
const narrow = 640; // pixels of a page that has no room for both panels

function button(id, text, title, action) {
  const one = make("button", { id, type: "button", textContent: text, title });
  one.addEventListener("click", action);
  return one;
}

class Editor {
  constructor() {
    this.mayEdit = false; // vv has said so on this connection
    this.selected = 0; // how many nodes
    this.readOnly = "";
    this.pressed = null; // where the left button went down on the picture
    this.pointer = null; // where the pointer is on the picture
    this.drag = null; // a value that is to be sent with the next frame of the page
    this.layOut();
    this.outline = new Outline($("rows"), (command, members) => this.edit(command, members));
    this.fields = new Fields($("fields"), {
      drag: (node, field, value, ends) => this.dragTo({ node, field, value }, ends),
      reset: (node, field) => this.edit("reset", { node, field }),
      select: (node) => this.edit("select", { node }),
    });
    this.listen();
    for (const type of ["editor", "rows", "reveal", "sheet", "frames", "history", "probes", "said"])
      page[`on_${type}`] = (message) => this[`on_${type}`](message);
    page.on_question = (message) => this.askToReplace(message.text);
  }

  edit(command, members = {}) {
    if (!this.mayEdit) return;
    const text = JSON.stringify({ type: "edit", command, ...members });
    if (new TextEncoder().encode(text).length > this.mostBytes)
      return this.say("this is too long to be sent", true);
    page.send({ type: "edit", command, ...members });
  }

  // Values of a drag are sent once a frame of the page. ends: the step of the drag is finished.
  dragTo(value, ends) {
    if (!this.drag && !ends) requestAnimationFrame(() => this.flush());
    this.drag = value;
    if (!ends) return;
    this.flush();
    this.edit("end_drag");
  }
  flush() {
    if (this.drag) this.edit("drag", this.drag);
    this.drag = null;
  }

  // --- The panels ---

  layOut() {
    const stage = $("stage");
    const work = make("div", { id: "work" });
    stage.replaceWith(work);
    const tools = make(
      "div",
      { id: "tools" },
      button("undo", "Undo", "Undo (Ctrl+Z)", () => this.edit("undo")),
      button("redo", "Redo", "Do again (Ctrl+Y)", () => this.edit("redo")),
      button("save", "Save", "Save the file in place (Ctrl+S)", () => this.edit("save")),
      button("revert", "Revert", "Read the file again, without these edits", () =>
        this.askToRevert(),
      ),
      make("select", { id: "kinds", label: "Node to add" }),
      button("add", "Add", "Add it to the selected group, or behind the selected node", () =>
        this.edit("add", { kind: $("kinds").value }),
      ),
      button("copy", "Copy", "Duplicate what is selected (Shift+D)", () => this.edit("duplicate")),
      button("group", "Group", "Put a Transform around what is selected (Ctrl+G)", () =>
        this.edit("wrap"),
      ),
      button("remove", "Remove", "Remove what is selected (Delete)", () => this.edit("remove")),
    );
    const search = make("input", {
      id: "search",
      type: "search",
      placeholder: "Search names, types and fields",
      label: "Search names, types and fields",
      maxLength: 64,
    });
    const outline = make(
      "aside",
      { id: "outline", label: "Outline" },
      tools,
      make("p", { id: "readonly", hidden: true }),
      search,
      make("div", { id: "rows", label: "Nodes of the world" }),
      make(
        "section",
        { id: "probes", label: "Probes of the light", hidden: true },
        make("h2", { textContent: "Probes" }),
        make("ol", { id: "readings" }),
        button("keep", "Keep as A", "Compare what follows with the light of now (B)", () =>
          this.edit("keep_probes"),
        ),
        button("clear", "Clear", "Remove all probes", () => this.edit("clear_probes")),
      ),
    );
    const rename = make("input", { id: "rename", label: "Name (DEF)", maxLength: 200 });
    rename.placeholder = "name (DEF)";
    const sheet = make(
      "aside",
      { id: "sheet", label: "Fields" },
      make("h2", { id: "title" }),
      make("p", { id: "note" }),
      rename,
      make("div", { id: "fields" }),
    );
    work.append(outline, stage, sheet);
    stage.append(make("p", { id: "said" }));
    $("said").setAttribute("role", "status");
    this.frames = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.frames.id = "frames";
    this.frames.setAttribute("viewBox", "-1 -1 2 2");
    this.frames.setAttribute("preserveAspectRatio", "none");
    this.frames.setAttribute("aria-hidden", "true");
    stage.append(this.frames);
    const toggle = (id, text, panel) => {
      const one = button(id, text, `Show or hide: ${text}`, () => this.toggle(panel));
      one.setAttribute("aria-controls", panel);
      return one;
    };
    $("bar").prepend(
      toggle("show-outline", "Outline", "outline"),
      toggle("show-sheet", "Fields", "sheet"),
    );
    for (const panel of [outline, sheet]) {
      panel.hidden = true;
      // Keys of the panels are not those of the world.
      for (const kind of ["keydown", "keyup"])
        panel.addEventListener(kind, (event) => event.stopPropagation());
    }
    this.showToggles(false);
  }

  showToggles(any) {
    for (const [id, panel] of [["show-outline", "outline"], ["show-sheet", "sheet"]]) {
      $(id).hidden = !any;
      $(id).setAttribute("aria-expanded", !$(panel).hidden);
    }
  }

  isOpen() {
    return !$("outline").hidden || !$("sheet").hidden;
  }

  toggle(panel) {
    const wasOpen = this.isOpen();
    $(panel).hidden = !$(panel).hidden;
    this.showToggles(true);
    if (this.isOpen() && !wasOpen) this.begin();
    if (!this.isOpen()) {
      this.frames.replaceChildren();
      this.edit("close");
    }
  }

  listen() {
    let timer = null;
    $("search").addEventListener("input", () => {
      clearTimeout(timer);
      timer = setTimeout(() => {
        $("rows").scrollTop = 0;
        this.edit("search", { text: $("search").value });
      }, 200);
    });
    $("rename").addEventListener("change", () => {
      const edits = [{ edit: "rename", node: this.fields.message.node, name: $("rename").value }];
      this.edit("step", { name: "Rename", edits });
    });
    window.addEventListener("keydown", (event) => this.keydown(event), { capture: true });
    const canvas = $("picture");
    canvas.addEventListener("pointerdown", (event) => {
      const isClick = this.isOpen() && event.button === 0 && !event.altKey;
      this.pressed = isClick ? page.picture.placeOf(event) : null;
    });
    canvas.addEventListener("pointermove", (event) => {
      this.pointer = page.picture.placeOf(event);
    });
    canvas.addEventListener("pointerleave", () => (this.pointer = null));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    new ResizeObserver(() => this.placeFrames()).observe($("stage"));
    const onState = page.connection.handlers.onState;
    page.connection.handlers.onState = (state, ...more) => {
      onState(state, ...more);
      if (state === "lost") this.lose();
    };
  }

  // Until vv says again that this page may edit, it may not.
  lose() {
    this.drag = null;
    this.setAllowed(false);
  }

  setAllowed(mayEdit) {
    this.mayEdit = mayEdit;
    for (const panel of ["outline", "sheet"]) $(panel).classList.toggle("off", !mayEdit);
  }

  // --- Mouse and keys ---

  release(event) {
    const from = this.pressed;
    this.pressed = null;
    if (!from || event.button !== 0) return;
    const { x, y } = page.picture.placeOf(event);
    if (Math.hypot(x - from.x, y - from.y) > clickDistance) return;
    if (Math.max(Math.abs(x), Math.abs(y)) > 1) return;
    this.edit("select_at", { x, y, group: event.ctrlKey, add: event.shiftKey });
  }

  // The window's keys of the editor. Where text is typed they belong to the text.
  keydown(event) {
    if (!this.isOpen() || $("panel").open || event.altKey || event.metaKey) return;
    const isTyped = /^(INPUT|TEXTAREA|SELECT)$/.test(event.target.tagName ?? "");
    const key = event.key.length === 1 ? event.key.toUpperCase() : event.key;
    const name = `${event.ctrlKey ? "Ctrl+" : ""}${event.shiftKey ? "Shift+" : ""}${key}`;
    const everywhere = {
      "Ctrl+Z": () => this.edit("undo"),
      "Ctrl+Y": () => this.edit("redo"),
      "Ctrl+Shift+Z": () => this.edit("redo"),
      "Ctrl+S": () => this.edit("save"),
    };
    const besidesText = {
      Delete: () => this.edit("remove"),
      "Shift+D": () => this.edit("duplicate"),
      "Ctrl+G": () => this.edit("wrap"),
      V: () => this.putProbe(),
      B: () => this.edit("keep_probes"),
    };
    if (this.selected > 0) besidesText.Escape = () => this.edit("select", { node: null });
    const action = everywhere[name] || (isTyped ? null : besidesText[name]);
    if (!action) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    if (isTyped) event.target.blur(); // what was typed counts before
    if (!event.repeat || name === "Ctrl+Z" || name === "Ctrl+Y") action();
  }

  putProbe() {
    const at = this.pointer;
    if (!at || Math.max(Math.abs(at.x), Math.abs(at.y)) > 1)
      return this.say("put the pointer where the light is to be measured", true);
    this.edit("probe", { x: at.x, y: at.y });
  }

  // --- Messages ---

  on_editor(message) {
    this.mostBytes = message.mostBytes;
    this.outline.most = message.mostRows;
    this.fields.most = message.mostElements;
    $("kinds").replaceChildren(...message.kinds.map((kind) => new Option(kind, kind)));
    this.setAllowed(true);
    if (!this.hasBegun) {
      $("outline").hidden = false;
      $("sheet").hidden = window.innerWidth < narrow;
    }
    this.hasBegun = true;
    this.showToggles(true);
    if (this.isOpen()) this.begin();
  }

  // Asks vv for what the editor shows.
  begin() {
    this.outline.ask(true);
    if ($("search").value) this.edit("search", { text: $("search").value });
  }

  on_rows(message) {
    this.outline.show(message);
  }

  on_reveal(message) {
    this.outline.reveal(message.row);
  }

  on_sheet(message) {
    const none = "Click on something in the picture or in the outline to select it.";
    $("title").textContent = message.title;
    $("note").textContent = message.node === null ? none : message.note;
    $("rename").hidden = message.node === null || !("name" in message);
    if (document.activeElement !== $("rename")) $("rename").value = message.name ?? "";
    this.fields.show(message);
  }

  on_frames(message) {
    const lines = message.lines.map(([x1, y1, x2, y2]) => {
      const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
      for (const [name, value] of Object.entries({ x1, y1: -y1, x2, y2: -y2 }))
        line.setAttribute(name, value);
      return line;
    });
    this.frames.replaceChildren(...lines);
    this.placeFrames();
  }

  // The lines lie over the picture, which may be narrower than its place.
  placeFrames() {
    const canvas = $("picture");
    const { clientWidth: width, clientHeight: height } = $("stage");
    const scale = Math.min(width / canvas.width, height / canvas.height);
    const [w, h] = [canvas.width * scale, canvas.height * scale];
    Object.assign(this.frames.style, {
      left: `${(width - w) / 2}px`,
      top: `${(height - h) / 2}px`,
      width: `${w}px`,
      height: `${h}px`,
    });
  }

  on_history(message) {
    this.selected = message.selected;
    this.readOnly = message.readOnly;
    const isEditable = message.readOnly === "";
    $("undo").disabled = !message.undo;
    $("undo").title = `Undo ${message.undo} (Ctrl+Z)`;
    $("redo").disabled = !message.redo;
    $("redo").title = `Do again: ${message.redo} (Ctrl+Y)`;
    for (const id of ["save", "revert"]) $(id).disabled = !message.unsaved;
    $("add").disabled = !isEditable;
    for (const id of ["copy", "group", "remove"])
      $(id).disabled = !isEditable || message.selected === 0;
    $("rename").disabled = !isEditable;
    $("readonly").hidden = isEditable;
    $("readonly").textContent = message.readOnly;
    document.body.dataset.unsaved = message.unsaved;
    this.fields.setEditable(isEditable);
    if (message.left !== null && message.left !== this.offered) this.offerLeft(message.left);
    this.offered = message.left;
  }

  on_probes(message) {
    $("probes").hidden = message.list.length === 0;
    const items = message.list.map((probe) => {
      const item = make("li", { value: probe.number, textContent: this.textOf(probe) });
      item.classList.toggle("uncertain", "change" in probe && !probe.significant);
      return item;
    });
    $("readings").replaceChildren(...items);
  }

  textOf(probe) {
    const states = {
      waiting: "waits for a still picture",
      hidden: "not seen from here",
      outside: "outside of the picture",
      other_view: "of another view",
    };
    if (probe.state !== "read") return states[probe.state];
    const digits = (number) => (number === null ? "?" : Number(number.toPrecision(3)));
    const value = `${digits(probe.luminance)} \u00b1 ${digits(probe.half_width)} cd/m\u00b2`;
    const trust = probe.trusted ? "trusted" : "not trusted";
    if (!("change" in probe)) return `${value} ${trust}`;
    const verdict = probe.significant ? "significant" : "not yet certain";
    const sign = probe.change > 0 ? "+" : "";
    const change = `${sign}${digits(probe.change)} \u00b1 ${digits(probe.change_half_width)}`;
    return `${value} ${trust}, B - A: ${change} ${verdict}`;
  }

  on_said(message) {
    this.say(message.text, message.error);
  }

  say(text, isError) {
    $("said").textContent = text;
    $("said").classList.toggle("error", isError);
    clearTimeout(this.silence);
    this.silence = setTimeout(() => ($("said").textContent = ""), saidSeconds * 1000);
  }

  // --- Questions ---

  // answers: name of the button, text, what it does; the last one changes nothing.
  ask(text, answers) {
    const buttons = answers.map(([id, label, title, action]) =>
      button(id, label, title, () => {
        $("panel").close();
        action();
      }),
    );
    const question = make("p", { textContent: text });
    page.showPanel(make("div", { id: "question" }, question, ...buttons));
    buttons.at(-1).focus();
  }

  askToReplace(text) {
    const replace = () => this.edit("save", { overwrite: true });
    this.ask(text, [
      ["replace", "Replace it", "Write the text with these edits over it", replace],
      ["dont", "Do not save", "Leave the file as it is (Escape)", () => {}],
    ]);
  }

  askToRevert() {
    this.ask("The edits of this world have not been saved.", [
      ["throw", "Throw them away", "Read the file again", () => this.edit("revert")],
      ["stay", "Stay", "Go on with these edits (Escape)", () => {}],
    ]);
  }

  offerLeft(seconds) {
    const when = new Date(seconds * 1000).toLocaleString();
    const recover = (use) => () => this.edit("recover", { use });
    this.ask(`Edits of ${when} have not been saved: the vv that kept them has ended.`, [
      ["use", "Use them", "Load the world with them; the file stays until you save", recover(true)],
      ["throw", "Throw them away", "Remove what is kept", recover(false)],
      ["later", "Decide later", "Ask again when the page is opened (Escape)", () => {}],
    ]);
  }
}

window.editor = new Editor();
