// edit.js: The editor on the page of `vv serve --edit`, for those who have opened its second
// address: the outline at the left, the fields of the selected node at the right, and questions.
// The other files of the editor are its parts. docs/serve.md lists the messages. It works on top of
// page.js.
"use strict";

import "./page.js";
import { Chooser } from "./chooser.js";
import { EditorKeys } from "./edit_keys.js";
import { Fields, make } from "./fields.js";
import { Importer } from "./importer.js";
import { Light } from "./light.js";
import { Nodes } from "./nodes.js";
import { Outline } from "./outline.js";
import { Problems, reportPanel } from "./reports.js";
import { Thumbnails } from "./thumbnails.js";
import { Tools, clickDistance } from "./tools.js";

const $ = (id) => document.getElementById(id);
const page = window.page;

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
    this.named = { node: null, name: "" }; // what the box of the name is for
    this.pressed = null; // where the left button went down on the picture
    this.pointer = null; // where the pointer is on the picture
    this.drag = null; // a value that is to be sent with the next frame of the page
    const edit = (command, members) => this.edit(command, members);
    this.layOut();
    this.chooser = new Chooser();
    this.thumbnails = new Thumbnails();
    const showText = (text) => page.on_command({ text });
    this.nodes = new Nodes(this.chooser, this.thumbnails, edit, showText);
    this.outline = new Outline($("rows"), edit, (row, item) => this.openRow(row, item));
    this.fields = new Fields($("fields"), {
      drag: (drag, ends) => this.dragTo(drag, ends),
      reset: (node, field) => this.edit("reset", { node, field }),
      nodes: (node, facts) => this.nodes.widget(node, facts),
    });
    const say = (text, isError) => this.say(text, isError);
    const isOpen = () => this.isOpen() && this.mayEdit;
    this.tools = new Tools($("stage"), page.picture, { edit, say, isOpen });
    this.importer = new Importer(edit, say, isOpen);
    this.light = new Light($("stage"), $("probes"), page.picture, { edit, isOpen });
    this.problems = new Problems($("problems"), $("show-problems"), edit);
    this.keys = new EditorKeys(this);
    this.listen();
    const types = ["editor", "rows", "reveal", "sheet", "history", "said"];
    for (const type of types) page[`on_${type}`] = (message) => this[`on_${type}`](message);
    page.on_question = (message) => this.askToReplace(message.text);
    page.on_frames = (message) => this.tools.onFrames(message);
    page.on_handles = (message) => this.onHandles(message);
    page.on_marks = (message) => this.tools.onMarks(message);
    page.on_tool = (message) => this.onTool(message);
    page.on_thumbnails = (message) => this.thumbnails.onThumbnails(message);
    page.on_looks = (message) => this.nodes.onLooks(message);
    page.on_choices = (message) => this.nodes.onChoices(message);
    page.on_probes = (message) => this.light.onProbes(message);
    page.on_comparison = (message) => this.light.onComparison(message);
    page.on_pointer = (message) => this.light.onPointer(message);
    page.on_cover = (message) => this.light.onCover(message);
    page.on_problems = (message) => this.problems.onProblems(message);
    page.on_import = (message) => this.importer.onImport(message);
    page.on_progress = (message) => this.onProgress(message);
    page.on_report = (message) => page.showPanel(reportPanel(message));
    page.showHelp = () => this.keys.showHelp();
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
      button("import", "Import", "Put files into the world: worlds or meshes, as Inlines", () =>
        this.importer.choose(),
      ),
      button("copy", "Copy", "Duplicate what is selected (Shift+D)", () => this.edit("duplicate")),
      button("group", "Group", "Put a Transform around what is selected (Ctrl+G)", () =>
        this.edit("wrap"),
      ),
      button("remove", "Remove", "Remove what is selected (X, Delete)", () => this.edit("remove")),
      button("handles", "Handles", "Handles that move, turn, scale, or none (T)", () =>
        this.edit("handles"),
      ),
      button("view", "View", "Hide nodes for now, show them again, go to them", () =>
        this.chooser.open("View", this.viewItems(), $("view")),
      ),
      button("show-problems", "Problems (0)", "Messages about the world", () => {}),
      button("report", "Report", "Make a page and a table of this view to download", () =>
        this.edit("report"),
      ),
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
      make("p", { id: "hidden", hidden: true }),
      make("div", { id: "rows", label: "Nodes of the world" }),
      make(
        "section",
        { id: "problems", label: "Problems of the world", hidden: true },
        make("h2", { textContent: "Problems" }),
        make("ul"),
      ),
      make(
        "section",
        { id: "probes", label: "Light" },
        make("h2", { textContent: "Light" }),
      ),
    );
    const rename = make("input", { id: "rename", label: "Name (DEF)", maxLength: 200 });
    rename.placeholder = "name (DEF)";
    const sheet = make(
      "aside",
      { id: "sheet", label: "Fields" },
      make("h2", { id: "title" }),
      make("p", { id: "note" }),
      make("div", { id: "texture" }),
      rename,
      make("div", { id: "look", label: "Look" }),
      make("div", { id: "fields" }),
    );
    work.append(outline, stage, sheet);
    $("facts").after(make("p", { id: "said" }), make("div", { id: "legend", hidden: true }));
    $("hint").before(make("p", { id: "tool" }), make("p", { id: "progress" }));
    for (const id of ["said", "tool", "progress"]) $(id).setAttribute("role", "status");
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
    this.follow(wasOpen);
  }

  setOpen(isOpen) {
    const wasOpen = this.isOpen();
    if (!isOpen && $("work").contains(document.activeElement)) $("picture").focus();
    $("outline").hidden = !isOpen;
    $("sheet").hidden = !isOpen || window.innerWidth < narrow;
    this.follow(wasOpen);
  }

  // The panels have been shown or hidden.
  follow(wasOpen) {
    this.showToggles(true);
    if (this.isOpen() && !wasOpen) this.begin();
    if (this.isOpen() || !wasOpen) return;
    this.tools.clear();
    this.light.clear();
    this.edit("close");
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
      this.named.name = $("rename").value;
      this.edit("step", { name: "Rename", edits: [{ edit: "rename", ...this.named }] });
      if (this.named.node !== this.fields.message.node) this.showName();
    });
    $("rename").addEventListener("blur", () => this.showName());
    const canvas = $("picture");
    canvas.addEventListener("pointerdown", (event) => {
      const isClick = this.isOpen() && event.button === 0 && !event.altKey;
      this.pressed = isClick ? page.picture.placeOf(event) : null;
    });
    const follow = (event) => {
      const isOver = $("stage").contains(event.target);
      this.pointer = isOver ? page.picture.placeOf(event) : null;
    };
    window.addEventListener("pointermove", follow, { capture: true });
    canvas.addEventListener("pointerup", (event) => this.release(event));
    const onState = page.connection.handlers.onState;
    page.connection.handlers.onState = (state, ...more) => {
      onState(state, ...more);
      if (state === "lost") this.lose();
    };
  }

  // Until vv says again that this page may edit, it may not.
  lose() {
    this.drag = null;
    this.tools.clear();
    this.light.clear();
    this.importer.clear();
    this.setAllowed(false);
  }

  setAllowed(mayEdit) {
    this.mayEdit = mayEdit;
    for (const panel of ["outline", "sheet"]) $(panel).classList.toggle("off", !mayEdit);
  }

  release(event) {
    const from = this.pressed;
    this.pressed = null;
    if (!from || event.button !== 0) return;
    const { x, y } = page.picture.placeOf(event);
    if (Math.hypot(x - from.x, y - from.y) > clickDistance) return;
    if (Math.max(Math.abs(x), Math.abs(y)) > 1) return;
    this.edit("select_at", { x, y, group: event.ctrlKey, add: event.shiftKey });
  }

  // --- Lists of commands ---

  viewItems() {
    const item = (label, command) => ({ label, action: () => this.edit(command) });
    return [
      item("Hide", "hide"),
      item("Show only this", "hide_others"),
      item("Show all", "show_all"),
      item("Select all with this look", "select_same_look"),
      item("Go to what is selected", "frame"),
    ];
  }

  // The menu of what can be added, as the list in the panel.
  openKinds() {
    const items = [...$("kinds").options].map(({ value: kind }) => ({
      label: kind,
      action: () => this.edit("add", { kind }),
    }));
    const files = { label: "Files ...", action: () => this.importer.choose() };
    this.chooser.open("Add", [...items, files], $("add"));
  }

  openRow(row, item) {
    const { node, parent = null, field = "", index } = row;
    const at = { node, parent, field, index };
    this.nodes.openPlace(row.label, at, null, item, ...this.viewItems());
  }

  // --- Messages ---

  on_editor(message) {
    this.mostBytes = message.mostBytes;
    this.outline.most = message.mostRows;
    this.fields.most = message.mostElements;
    this.importer.begin(message);
    this.keys.rows = message.keys;
    $("kinds").replaceChildren(...message.kinds.map((kind) => new Option(kind, kind)));
    this.setAllowed(true);
    const isFirst = !this.hasBegun;
    this.hasBegun = true;
    if (isFirst) return this.setOpen(true);
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
    const none =
      "Click on something in the picture or in the outline to select it. V or U measures the " +
      "light where the pointer is. F1 lists all keys.";
    $("title").textContent = message.title;
    $("note").textContent = message.node === null ? none : message.note;
    $("rename").hidden = message.node === null || !("name" in message);
    if (message.node !== this.fields.message?.node) {
      const own = message.node === null ? [] : [this.thumbnails.placeOf(message.node)];
      $("texture").replaceChildren(...own);
    }
    this.nodes.showLook($("look"), message.look, this.readOnly === "");
    this.fields.show(message);
    this.showName();
  }

  // A name that is being typed stays, with the node that it is for.
  showName() {
    const { node = null, name = "" } = this.fields.message ?? {};
    const box = $("rename");
    if (document.activeElement === box && box.value !== this.named.name) return;
    this.named = { node, name };
    box.value = name;
  }

  onHandles(message) {
    $("handles").textContent = `Handles: ${message.kind}`;
    this.tools.onHandles(message);
  }

  onTool(message) {
    $("tool").textContent = message.text;
    this.tools.onTool(message);
  }

  onProgress(message) {
    this.isReporting = message.text !== "";
    $("progress").textContent = message.text;
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
    for (const id of ["add", "import"]) $(id).disabled = !isEditable;
    for (const id of ["copy", "group", "remove"])
      $(id).disabled = !isEditable || message.selected === 0;
    $("rename").disabled = !isEditable;
    $("handles").disabled = !isEditable;
    $("save").textContent = message.unsaved ? "Save *" : "Save";
    $("hidden").hidden = message.hidden === 0;
    $("hidden").textContent = `${message.hidden} nodes are hidden: View, Show all`;
    $("readonly").hidden = isEditable;
    $("readonly").textContent = message.readOnly;
    document.body.dataset.unsaved = message.unsaved;
    this.fields.setEditable(isEditable);
    if (message.left !== null && message.left !== this.offered) this.offerLeft(message.left);
    this.offered = message.left;
  }

  on_said(message) {
    if (message.error) this.tools.onRefused();
    this.say(message.text, message.error);
  }

  say(text, isError) {
    $("said").textContent = isError ? `\u26a0 ${text}` : text;
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
