// tools.js: What lies over the picture of the editor: the handles and the tool that move, turn and
// scale, rectangles that select and measure, the boxes of what is selected, and the marks of
// probes. Places of the picture go from -1 to 1, as in all messages.
"use strict";

const svgNames = "http://www.w3.org/2000/svg";
const axes = ["x", "y", "z"];
// How far the pointer may move between press and release of a click, as a part of the picture.
export const clickDistance = 0.012;

function draw(tag, attributes, ...children) {
  const element = document.createElementNS(svgNames, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

const within = ({ x, y }) => ({
  x: Math.max(-1, Math.min(1, x)),
  y: Math.max(-1, Math.min(1, y)),
});
const isFar = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) > clickDistance;

// Returns where the picture is within the stage, which may be wider or higher.
export function areaOf(canvas, stage) {
  const scale = Math.min(stage.clientWidth / canvas.width, stage.clientHeight / canvas.height);
  const [width, height] = [canvas.width * scale, canvas.height * scale];
  return {
    left: (stage.clientWidth - width) / 2,
    top: (stage.clientHeight - height) / 2,
    width,
    height,
  };
}

export class Tools {
  // picture: has canvas and placeOf(event). edit: sends a command of the editor. say: tells the
  // user something. isOpen: tells whether the editor is open.
  constructor(stage, picture, { edit, say, isOpen }) {
    Object.assign(this, { stage, picture, edit, say, isOpen });
    this.frames = [];
    this.marks = [];
    this.handles = { kind: "none", list: [] };
    this.mode = null; // a tool is in use
    this.pressed = null; // where a handle was pressed
    this.rectangle = null; // what is drawn with the pointer
    this.measures = false; // the next drag measures
    this.svg = draw("svg", { id: "overlay", "aria-hidden": "true" }); // keys do the same
    stage.append(this.svg);
    this.svg.addEventListener("wheel", (event) =>
      picture.canvas.dispatchEvent(new WheelEvent("wheel", event)),
    );
    new ResizeObserver(() => this.draw()).observe(stage);
    for (const kind of ["pointerdown", "pointermove", "pointerup", "pointercancel"])
      window.addEventListener(kind, (event) => this[kind](event), { capture: true });
  }

  // --- What is shown ---

  onFrames(message) {
    this.frames = message.lines;
    this.draw();
  }
  onHandles(message) {
    this.handles = message;
    this.draw();
  }
  onMarks(message) {
    this.marks = message.list;
    this.draw();
  }

  clear() {
    this.frames = this.marks = [];
    this.handles = { kind: "none", list: [] };
    this.mode = this.pressed = this.rectangle = null;
    this.measures = false;
    this.draw();
  }

  draw() {
    const area = areaOf(this.picture.canvas, this.stage);
    for (const side of ["left", "top", "width", "height"])
      this.svg.style[side] = `${area[side]}px`;
    const x = (place) => (((1 + place) / 2) * area.width).toFixed(1);
    const y = (place) => (((1 - place) / 2) * area.height).toFixed(1);
    const line = ([x1, y1, x2, y2], attributes) =>
      draw("line", { x1: x(x1), y1: y(y1), x2: x(x2), y2: y(y2), ...attributes });
    const box = ({ left, top, right, bottom }) =>
      draw("rect", {
        x: x(left),
        y: y(top),
        width: x(right) - x(left),
        height: y(bottom) - y(top),
      });
    const label = (text, atX, atY, dx, dy) => {
      const one = draw("text", { x: x(atX), y: y(atY), dx, dy });
      one.textContent = text;
      return one;
    };
    const frames = draw("g", { id: "frames" });
    frames.append(...this.frames.map((one) => line(one, {})));
    const marks = draw("g", { id: "marks" });
    for (const mark of this.marks)
      if ("left" in mark) marks.append(box(mark), label(mark.number, mark.left, mark.top, 4, 14));
      else
        marks.append(
          draw("circle", { cx: x(mark.x), cy: y(mark.y), r: 4 }),
          label(mark.number, mark.x, mark.y, 7, 4),
        );
    const handles = this.handles.list.map((one) => {
      const lines = (name) => one.lines.map((ends) => line(ends, { class: name }));
      const letter = (one.opposite ? "-" : "") + axes[one.axis];
      const place = label(letter, one.end[0], one.end[1], 7, -6);
      const head = this.head(one, x, y);
      return draw(
        "g",
        { class: `handle axis-${axes[one.axis]}`, "data-axis": one.axis },
        ...lines("shadow"),
        ...lines("shaft"),
        ...head,
        place,
        ...lines("reach"),
      );
    });
    const drawn = this.rectangle ? [box(this.corners())] : [];
    this.svg.replaceChildren(frames, marks, ...handles, draw("g", { id: "drawn" }, ...drawn));
  }

  // Returns the head of an arrow, or its box. The letter beside it tells the axes apart, too.
  head(handle, x, y) {
    if (this.handles.kind === "turn") return [];
    const [fromX, fromY] = [Number(x(handle.lines[0][0])), Number(y(handle.lines[0][1]))];
    const [toX, toY] = [Number(x(handle.end[0])), Number(y(handle.end[1]))];
    if (this.handles.kind === "scale")
      return [draw("rect", { class: "head", x: toX - 5, y: toY - 5, width: 10, height: 10 })];
    const length = Math.hypot(toX - fromX, toY - fromY);
    if (!(length > 0)) return [];
    const [alongX, alongY] = [((toX - fromX) / length) * 12, ((toY - fromY) / length) * 12];
    const [acrossX, acrossY] = [-alongY * 0.4, alongX * 0.4];
    const corners = [
      [toX, toY],
      [toX - alongX + acrossX, toY - alongY + acrossY],
      [toX - alongX - acrossX, toY - alongY - acrossY],
    ];
    return [draw("polygon", { class: "head", points: corners.map((c) => c.join()).join(" ") })];
  }

  // --- The tool ---

  begin(kind, place, axis = -1) {
    this.mode = { isConfirmed: false, hasFailed: false, place };
    this.edit("tool", { kind, x: place.x, y: place.y, ...(axis >= 0 && { axis }) });
  }

  end(accept) {
    this.flush();
    if (this.mode && !this.mode.hasFailed) this.edit("end_tool", { accept });
    this.mode = this.pressed = null;
  }

  // The pointer has moved: one place is sent with each frame of the page.
  moveTo(place, snap) {
    if (!this.waiting) requestAnimationFrame(() => this.flush());
    this.waiting = { ...place, snap };
    this.mode.place = place;
  }
  flush() {
    if (this.waiting && this.mode && !this.mode.hasFailed) this.edit("tool_at", this.waiting);
    this.waiting = null;
  }

  onTool(message) {
    if (!this.mode) return;
    if (message.text) this.mode.isConfirmed = true;
    else if (this.mode.isConfirmed) this.mode = null; // somebody else's edit has ended it
  }

  // vv has refused something. A tool that could not begin keeps its keys: an axis is no command.
  onRefused() {
    if (this.mode && !this.mode.isConfirmed) this.mode.hasFailed = true;
  }

  // Takes a key while a tool is in use. Returns whether it was for the tool.
  takeKey(event) {
    if (this.measures || this.rectangle) return this.takeKeyOfRectangle(event);
    if (!this.mode) return false;
    const key = event.key.length === 1 ? event.key.toUpperCase() : event.key;
    const isToolKey = /^([0-9.XYZ-]|Backspace)$/.test(key) && !event.ctrlKey;
    if (this.mode.hasFailed && !isToolKey) {
      this.mode = null;
      return key === "Escape";
    }
    if (isToolKey) {
      this.flush();
      if (!this.mode.hasFailed) this.edit("tool_key", { key });
    } else if (key === "Enter" || key === "Escape") {
      this.end(key === "Enter");
    } else if (key === "Control") {
      this.moveTo(this.mode.place, event.type === "keydown");
    } else if (!["Shift", "Alt", "Meta", "Tab"].includes(key) && event.type === "keydown") {
      this.say("end this first: Enter keeps it, Escape takes it back", true);
    }
    return true;
  }

  // --- Rectangles ---

  measure() {
    this.measures = true;
    this.say("drag a rectangle over what is to be measured (Enter: all; Escape: nothing)", false);
  }

  takeKeyOfRectangle(event) {
    if (event.key === "Enter" && this.measures && event.type === "keydown") {
      this.edit("measure", { x0: -1, y0: -1, x1: 1, y1: 1 });
    } else if (event.key !== "Escape") {
      return false;
    }
    this.measures = false;
    this.rectangle = null;
    this.draw();
    return true;
  }

  corners() {
    const { from, to } = this.rectangle;
    return {
      left: Math.min(from.x, to.x),
      right: Math.max(from.x, to.x),
      bottom: Math.min(from.y, to.y),
      top: Math.max(from.y, to.y),
    };
  }

  endRectangle(event) {
    const { what, from, to } = this.rectangle;
    this.rectangle = null;
    this.draw();
    const members = { x0: from.x, y0: from.y, x1: to.x, y1: to.y };
    if (what === "measure") {
      if (isFar(from, to)) this.edit("measure", members);
      else this.say("drag from one corner of the rectangle to the other", true);
    } else if (isFar(from, to)) {
      this.edit("select_in", { ...members, add: event.shiftKey });
    } else {
      this.edit("select_at", { ...to, group: true, add: event.shiftKey });
    }
  }

  // --- The pointer, before the page gets it ---

  take(event) {
    event.preventDefault();
    event.stopPropagation();
  }

  pointerdown(event) {
    if (!this.isOpen()) return;
    if (this.mode) {
      this.mode.isClicked = true;
      return this.take(event);
    }
    const isPicture = event.target === this.picture.canvas;
    const handle = event.target.closest?.(".handle");
    if (event.button !== 0 || event.altKey || !(isPicture || handle)) return;
    const place = this.picture.placeOf(event);
    if (this.measures || (event.ctrlKey && !handle)) {
      const what = this.measures ? "measure" : "select";
      this.measures = false;
      this.rectangle = { what, from: within(place), to: within(place) };
    } else if (handle) {
      this.pressed = { place, axis: Number(handle.dataset.axis), kind: this.handles.kind };
    } else {
      return;
    }
    this.picture.canvas.focus();
    this.svg.setPointerCapture(event.pointerId); // handles are drawn anew meanwhile
    this.take(event);
  }

  pointermove(event) {
    const place = this.picture.placeOf(event);
    if (this.rectangle) {
      this.rectangle.to = within(place);
      this.draw();
      return this.take(event);
    }
    if (this.pressed && !this.mode && isFar(place, this.pressed.place))
      this.begin(this.pressed.kind, this.pressed.place, this.pressed.axis);
    if (!this.mode && !this.pressed) return;
    if (this.mode) this.moveTo(place, event.ctrlKey);
    this.take(event);
  }

  pointerup(event) {
    if (this.rectangle) {
      this.endRectangle(event);
    } else if (this.mode && (this.mode.isClicked || this.pressed)) {
      this.end(event.button === 0);
    } else if (this.pressed) {
      const { x, y } = within(this.pressed.place); // a click: what is behind the handle
      this.pressed = null;
      this.edit("select_at", { x, y, group: event.ctrlKey, add: event.shiftKey });
    } else {
      return;
    }
    this.take(event);
  }

  pointercancel() {
    if (this.mode) this.end(true);
    this.pressed = this.rectangle = null;
    this.draw();
  }
}
