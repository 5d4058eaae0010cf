// fields.js: The fields of the selected node as widgets. A widget has an element, shows a value by
// set(), tells by isActive() whether its user is in the middle of something, and calls
// change(value, ends) for a new value; `ends` is false while it is dragged. A list calls it for one
// of its elements: change(value, ends, { index, size }), where null removes the element.
"use strict";

const counts = { Float: 1, Double: 1, Time: 1, Int32: 1, Color: 3, ColorRGBA: 4, Rotation: 4 };
const degrees = 180 / Math.PI;
let lists = 0; // of words, so far

// label: what a screen reader says.
export function make(tag, { label, ...properties } = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  if (label) element.setAttribute("aria-label", label);
  element.append(...children);
  return element;
}

// Returns a list with another element at a place.
function replaced(list, place, element) {
  const fresh = [...list];
  fresh[place] = element;
  return fresh;
}

// Returns how many numbers an element of a type has; 0: it has none.
function countOf(type) {
  const vector = /^Vec([234])/.exec(type);
  const matrix = /^Matrix([34])/.exec(type);
  return counts[type] || (vector ? Number(vector[1]) : matrix ? matrix[1] ** 2 : 0);
}

// Numbers that come from a drag or a picker are short ones, so that files stay readable.
function short(number) {
  return Number(number.toPrecision(4));
}

// --- Widgets ---

// facts: the field, with its range.
function numberWidget(facts, label, change) {
  const input = make("input", { type: "number", step: "any", label });
  const whole = facts.type.endsWith("Int32");
  if ("least" in facts) input.min = facts.least;
  if ("most" in facts) input.max = facts.most;
  if (whole) input.step = 1;
  let shown = "";
  let pressed = null; // where the pointer went down, and the value then
  let isDragging = false;
  const limited = (value) =>
    Math.min(facts.most ?? Infinity, Math.max(facts.least ?? -Infinity, value));
  const end = () => {
    if (isDragging && input.value !== "") change(Number(input.value), true);
    pressed = null;
    isDragging = false;
  };
  input.addEventListener("pointerdown", (event) => {
    if (event.button === 0) pressed = { x: event.clientX, value: Number(input.value) || 0 };
  });
  input.addEventListener("pointermove", (event) => {
    if (!(event.buttons & 1)) pressed = null; // it was released elsewhere
    if (!pressed || input.disabled) return;
    const moved = event.clientX - pressed.x;
    if (!isDragging && Math.abs(moved) < 4) return;
    if (!isDragging) input.setPointerCapture(event.pointerId);
    isDragging = true;
    const speed = whole ? 0.1 : Math.abs(pressed.value) * 0.01 || 0.01;
    const value = limited(pressed.value + moved * speed);
    input.value = shown = String(whole ? Math.round(value) : short(value));
    change(Number(input.value), false);
  });
  input.addEventListener("pointerup", end);
  input.addEventListener("pointercancel", end);
  input.addEventListener("lostpointercapture", end);
  input.addEventListener("change", () => {
    if (input.value === "" || !Number.isFinite(input.valueAsNumber)) input.value = shown;
    else if (input.value !== shown) change(Number((shown = input.value)), true);
  });
  return {
    element: input,
    set: (value) => (input.value = shown = value === null ? "" : String(value)),
    isActive: () => isDragging || (document.activeElement === input && input.value !== shown),
  };
}

// Several numbers beside each other.
function numbersWidget(facts, label, count, names, change) {
  let value = [];
  const widgets = Array.from({ length: count }, (_, i) =>
    numberWidget(facts, `${label} ${names[i] ?? i + 1}`, (number, ends) => {
      value = replaced(value, i, number);
      change(value, ends);
    }),
  );
  return {
    element: make("span", { className: "numbers" }, ...widgets.map((one) => one.element)),
    set: (fresh) => {
      value = fresh;
      widgets.forEach((one, i) => one.isActive() || one.set(fresh[i]));
    },
    isActive: () => widgets.some((one) => one.isActive()),
  };
}

// The picker shows codes of sRGB. The colours of a file are such codes, too, except parameters of
// shaders, which are linear.
const encode = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
const decode = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

function colourWidget(facts, label, count, change) {
  let value = [];
  let isPicking = false;
  const parts = ["red", "green", "blue", "alpha"];
  const numbers = numbersWidget(facts, label, count, parts, (v, ends) => change((value = v), ends));
  const picker = make("input", { type: "color", label: `${label} picker` });
  const byte = (c) => Math.round(255 * Math.min(1, Math.max(0, facts.linear ? encode(c) : c)));
  const pick = (ends) => {
    isPicking = !ends;
    const codes = [1, 3, 5].map((i) => parseInt(picker.value.slice(i, i + 2), 16) / 255);
    const fresh = codes.map((c) => short(facts.linear ? decode(c) : c));
    value = [...fresh, ...value.slice(3)];
    numbers.set(value);
    change(value, ends);
  };
  picker.addEventListener("input", () => pick(false));
  picker.addEventListener("change", () => pick(true));
  return {
    element: make("span", { className: "colour" }, picker, numbers.element),
    set: (fresh) => {
      value = fresh;
      numbers.set(fresh);
      const hex = (c) => byte(c).toString(16).padStart(2, "0");
      picker.value = `#${fresh.slice(0, 3).map(hex).join("")}`;
    },
    isActive: () => isPicking || numbers.isActive(),
  };
}

function rotationWidget(label, change) {
  let value = [0, 0, 1, 0];
  const facts = { type: "SFFloat" };
  const axis = numbersWidget(facts, `${label} axis`, 3, ["x", "y", "z"], (v, ends) => {
    value = [...v, value[3]];
    change(value, ends);
  });
  const angle = numberWidget(facts, `${label} degrees`, (number, ends) => {
    value = [...value.slice(0, 3), number / degrees];
    change(value, ends);
  });
  return {
    element: make("span", { className: "rotation" }, axis.element, angle.element, "\u00b0"),
    set: (fresh) => {
      value = fresh;
      axis.set(fresh.slice(0, 3));
      if (!angle.isActive()) angle.set(Number((fresh[3] * degrees).toPrecision(6)));
    },
    isActive: () => axis.isActive() || angle.isActive(),
  };
}

function switchWidget(label, change) {
  const input = make("input", { type: "checkbox", label });
  input.addEventListener("change", () => change(input.checked, true));
  return { element: input, set: (value) => (input.checked = value), isActive: () => false };
}

// choices: words that are proposed.
function textWidget(label, choices, change) {
  const words = make("datalist", { id: `words-${++lists}` });
  words.append(...(choices ?? []).map((word) => make("option", { value: word })));
  const input = choices
    ? make("input", { type: "text", spellcheck: false, label })
    : make("textarea", { rows: 1, spellcheck: false, label });
  if (choices) input.setAttribute("list", words.id);
  let shown = "";
  input.addEventListener("change", () => {
    if (input.value !== shown) change((shown = input.value), true);
  });
  return {
    element: choices ? make("span", { className: "text" }, input, words) : input,
    set: (value) => {
      input.value = shown = value;
      if (!choices) input.rows = Math.min(8, value.split("\n").length);
    },
    isActive: () => document.activeElement === input && input.value !== shown,
  };
}

// Returns the widget of one element of a type, such as "Vec3f"; null: there is none.
function elementWidget(type, facts, label, change) {
  if (type === "Bool") return switchWidget(label, change);
  if (type === "String") return textWidget(label, facts.choices, change);
  if (type === "Rotation") return rotationWidget(label, change);
  const count = countOf(type);
  if (type.startsWith("Color")) return colourWidget(facts, label, count, change);
  if (count === 1) return numberWidget(facts, label, change);
  return count > 0 ? numbersWidget(facts, label, count, ["x", "y", "z", "w"], change) : null;
}

const emptyElements = { Bool: false, String: "", Rotation: [0, 0, 1, 0] };

// A table of the elements of a list. Only the element that is changed is sent, so that others stay as
// other pages have set them meanwhile.
function listWidget(type, facts, most, change) {
  const table = make("table");
  const add = make("button", { type: "button", textContent: "+", title: "Add an element" });
  let value = [];
  let widgets = [];
  const send = (element, ends, index) => change(element, ends, { index, size: value.length });
  add.addEventListener("click", () => {
    const zeros = countOf(type) === 1 ? 0 : Array(countOf(type)).fill(0);
    const element = value.at(-1) ?? emptyElements[type] ?? zeros;
    send(element, true, value.length);
    value = [...value, element];
  });
  const remove = (index) => {
    send(null, true, index);
    value = value.filter((_, i) => i !== index);
  };
  const rebuild = () => {
    table.replaceChildren();
    widgets = value.map((_, i) => {
      const label = `${facts.field} ${i + 1}`;
      const one = elementWidget(type, facts, label, (v, ends) => {
        send(v, ends, i);
        value = replaced(value, i, v);
      });
      const button = make("button", {
        type: "button",
        textContent: "\u00d7",
        label: `Remove ${label}`,
      });
      button.addEventListener("click", () => remove(i));
      const row = table.insertRow();
      row.insertCell().append(one.element);
      row.insertCell().append(button);
      return one;
    });
  };
  return {
    element: make("div", { className: "list" }, table, add),
    set: (fresh) => {
      value = fresh;
      if (fresh.length !== widgets.length) rebuild();
      widgets.forEach((one, i) => one.isActive() || one.set(fresh[i]));
      add.hidden = fresh.length >= most;
    },
    isActive: () => widgets.some((one) => one.isActive()),
  };
}

// --- The sheet ---

export class Fields {
  // actions: drag(drag, ends), where `drag` has node, field, value and perhaps the place of an
  // element; reset(node, field); and nodes(node, facts), which returns a widget for a field of nodes.
  constructor(element, actions) {
    this.element = element;
    this.actions = actions;
    this.most = 200; // elements of a list that has a table
    this.shape = "";
    this.rows = [];
    this.isEditable = true;
    // What had to wait until the user was done.
    const again = () => this.message && this.show(this.message);
    element.addEventListener("focusout", () => setTimeout(again));
    element.addEventListener("pointerup", () => setTimeout(again));
  }

  // Says which fields there are: while that stays, only values are set.
  shapeOf(message) {
    const rows = message.fields.map((f) => [f.field, f.type, f.long, f.declared, !f.links]);
    return JSON.stringify([message.node, rows]);
  }

  show(message) {
    this.message = message;
    const shape = this.shapeOf(message);
    if (shape !== this.shape) {
      if (this.rows.some((row) => row.widget?.isActive())) return; // again when that ends
      this.rebuild(message);
      this.shape = shape;
    }
    message.fields.forEach((facts, i) => this.update(this.rows[i], facts));
    this.setEditable(this.isEditable);
  }

  rebuild(message) {
    const path = this.pathOf(document.activeElement); // the keyboard stays where it is
    if (this.node !== message.node) this.element.parentElement.scrollTop = 0;
    this.node = message.node;
    this.rows = message.fields.map((facts) => this.make(facts));
    const more = make("p", { textContent: `${message.hidden} more fields` });
    this.element.replaceChildren(...this.rows.map((row) => row.element));
    if (message.hidden) this.element.append(more);
    if (path) this.controls().find((one) => this.pathOf(one) === path)?.focus();
  }

  controls(within = this.element) {
    return [...within.querySelectorAll("input, textarea, button")];
  }
  pathOf(control) {
    const row = this.element.contains(control) ? control.closest(".field") : null;
    return row ? `${this.controls(row).indexOf(control)} ${row.dataset.field}` : "";
  }

  make(facts) {
    const name = make("span", { className: "name", textContent: facts.field });
    name.title = facts.help;
    const reset = make("button", {
      type: "button",
      className: "reset",
      textContent: "\u21ba",
      title: "Reset to the default (right click on the name)",
      label: `Reset ${facts.field}`,
    });
    const row = { reset, facts, element: make("div", { className: "field" }) };
    reset.addEventListener("click", () => this.actions.reset(this.node, facts.field));
    name.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      if (!reset.hidden && this.isEditable) this.actions.reset(this.node, facts.field);
    });
    row.element.dataset.field = facts.field;
    row.element.append(make("div", { className: "head" }, name, reset), this.content(row));
    return row;
  }

  content(row) {
    const facts = row.facts;
    if (facts.links) {
      row.nodes = this.actions.nodes(this.node, facts);
      return row.nodes.element;
    }
    const type = facts.type.slice(2);
    const isList = facts.type.startsWith("MF");
    const node = this.node;
    const change = (value, ends, element) =>
      this.actions.drag({ node, field: facts.field, value, ...element }, ends);
    if (!facts.long && isList) row.widget = listWidget(type, facts, this.most, change);
    else if (!facts.long) row.widget = elementWidget(type, facts, facts.field, change);
    if (row.widget) return row.widget.element;
    const text = isList ? `${facts.type} of ${facts.size}` : facts.type;
    return make("span", { className: "long", textContent: text });
  }

  update(row, facts) {
    row.facts = facts;
    row.element.classList.toggle("default", facts.default);
    row.element.classList.toggle("edited", Boolean(facts.edited));
    row.reset.hidden = facts.default || !facts.declared || Boolean(facts.links);
    if (row.widget && !row.widget.isActive()) row.widget.set(facts.value);
    row.nodes?.set(facts);
  }

  setEditable(isEditable) {
    this.isEditable = isEditable;
    this.element.classList.toggle("readonly", !isEditable);
    for (const control of this.controls())
      if (!control.classList.contains("link")) control.disabled = !isEditable;
  }
}
