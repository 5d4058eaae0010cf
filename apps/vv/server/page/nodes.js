// nodes.js: The nodes in the fields of the selected node, the look of a Shape, and the commands for
// a row of the outline.
"use strict";

import { make } from "./fields.js";

function small(text, label, action) {
  const one = make("button", { type: "button", textContent: text, title: label, label });
  one.addEventListener("click", action);
  return one;
}

export class Nodes {
  // edit: sends a command of the editor. show: shows a text that can be copied.
  constructor(chooser, thumbnails, edit, show) {
    Object.assign(this, { chooser, thumbnails, edit, show });
    this.looks = [];
    this.isOnlyHere = true; // what the user chose last
  }

  // Returns a widget for a field of nodes, which has an element and set().
  widget(owner, facts) {
    const element = make("div", { className: "links" });
    let shown = "";
    const set = (fresh) => {
      const text = JSON.stringify(fresh.links);
      if (text === shown) return;
      shown = text;
      const buttons = [...element.querySelectorAll("button")];
      const focused = buttons.indexOf(document.activeElement);
      const rows = fresh.links.flatMap((one, i) => this.link(owner, fresh, one, i));
      element.replaceChildren(...rows, this.addButton(owner, fresh));
      if (focused >= 0) [...element.querySelectorAll("button")].at(focused)?.focus();
    };
    set(facts);
    return { element, set };
  }

  // Returns elements for a node: a click selects it, and buttons move it, make it separate and remove
  // it.
  link(owner, facts, one, index) {
    if (!one) return [make("span", { className: "long", textContent: "NULL" })];
    const at = { node: one.node, parent: owner, field: facts.field, index };
    const places = one.places > 1 ? `It stands in ${one.places} places. ` : "";
    const label = (one.places > 1 ? `(${one.places}) ` : "") + one.label;
    const name = make("button", { type: "button", className: "link", textContent: label });
    name.title = `${places}Select it; a right click lists what can be done with it`;
    name.dataset.node = one.node;
    name.addEventListener("click", () => this.edit("select", { node: one.node }));
    name.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      this.openPlace(one.label, at, one.places, name);
    });
    const row = make("span", { className: "chip" }, name);
    const what = `${one.label} in ${facts.field}`;
    if (facts.links.length > 1) {
      const up = small("\u2191", `Move up: ${what}`, () => this.edit("move_at", { ...at, by: -1 }));
      const down = small("\u2193", `Move down: ${what}`, () =>
        this.edit("move_at", { ...at, by: 1 }),
      );
      row.append(up, down);
    }
    if (one.places > 1)
      row.append(small("Own", `Make this one separate: ${what}`, () =>
        this.edit("separate_at", at),
      ));
    row.append(small("\u00d7", `Remove ${what}`, () => this.edit("remove_at", at)));
    return [row, this.thumbnails.placeOf(one.node)];
  }

  addButton(owner, facts) {
    const replaces = facts.type === "SFNode" && facts.links.some((one) => one);
    const text = replaces ? "Replace" : "Add";
    const one = small(text, `${text}: ${facts.field}`, () => {
      this.anchor = one;
      this.edit("choices", { node: owner, field: facts.field });
    });
    return one;
  }

  // What may be put into a field has come.
  onChoices(message) {
    const { node, field } = message;
    const anchor = this.anchor?.isConnected ? this.anchor : document.getElementById("fields");
    const types = message.types.map(({ name, text }) => ({
      label: name,
      text,
      action: () => this.edit("add_node", { node, field, kind: name }),
    }));
    const uses = message.uses.map((one) => ({
      label: `USE ${one.label}`,
      text: "Let this node stand here, too",
      action: () => this.edit("use_node", { node, field, used: one.node }),
    }));
    this.chooser.open(`Add to ${field}`, [...types, ...uses], anchor);
  }

  // Lists what can be done with one of the places of a node.
  openPlace(label, at, places, anchor, ...more) {
    const action = (name, members = {}) => () => this.edit(name, { ...at, ...members });
    const items = [
      ...more,
      { label: "Move up", action: action("move_at", { by: -1 }) },
      { label: "Move down", action: action("move_at", { by: 1 }) },
      { label: "Remove from here", action: action("remove_at") },
    ];
    // How often a row of the outline stands in the file is not known: vv says it.
    if (places !== 1)
      items.push({ label: "Make this one separate", action: action("separate_at") });
    this.chooser.open(label, items, anchor);
  }

  // --- The look of a Shape ---

  onLooks(message) {
    this.looks = message.list;
    this.refreshLooks?.();
  }

  // look: undefined for other nodes than Shapes.
  showLook(place, look, isEditable) {
    const text = JSON.stringify([look, isEditable]);
    if (text === this.shown) return;
    this.shown = text;
    if (!look) return place.replaceChildren();
    const name = small(look.name || "choose a material or a shader", "Choose another look", () =>
      this.chooseLook(look, name),
    );
    name.className = "link";
    name.disabled = !isEditable;
    name.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      if (look.option) this.show(look.option);
    });
    const show = small("\u2192", "Show the fields of the material or the shader", () =>
      this.edit("select", { node: look.surface }),
    );
    const same = small("=", "Select all Shapes with the same look", () =>
      this.edit("select_same_look"),
    );
    show.disabled = same.disabled = look.surface === null;
    place.replaceChildren(make("span", { textContent: "look" }), name, show, same);
  }

  chooseLook(look, anchor) {
    const box = make("input", { type: "checkbox", checked: this.isOnlyHere });
    box.addEventListener("change", () => (this.isOnlyHere = box.checked));
    const note = `Change it only here: the appearance stands in ${look.places} places`;
    const only = make("label", {}, box, note);
    const items = () =>
      this.looks.map(({ number, name, text: about, image, own }) => ({
        label: name,
        text: about,
        image,
        note: own ? "yours" : "",
        action: () => this.edit("set_look", { number, only_here: this.isOnlyHere }),
      }));
    const more = look.places > 1 ? [only] : [];
    this.chooser.open("Materials and shaders", items(), anchor, ...more);
    this.edit("looks", { open: true }); // their balls are drawn now
    this.refreshLooks = () => this.chooser.refresh(items());
    this.chooser.onClose = () => {
      this.refreshLooks = null;
      this.edit("looks", { open: false });
    };
  }
}
