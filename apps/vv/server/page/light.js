// light.js: The light that the editor looks at: what the probes read, and A, the picture that was
// kept, in the place of the present one, beside it, or what has changed since.
"use strict";

import { make } from "./fields.js";
import { areaOf } from "./tools.js";

const restSeconds = 0.4; // until a pointer that does not move rests

const states = {
  waiting: "waits for a still picture",
  hidden: "not seen from here",
  outside: "outside of the picture",
  other_view: "of another view",
};

function digits(number) {
  return number === null ? "?" : String(Number(number.toPrecision(3)));
}
function signed(number) {
  return (number > 0 ? "+" : "") + digits(number);
}

// A number with its interval and unit, which stay in one line.
function quantity(value, halfWidth, unit, asChange = false) {
  const text = `${asChange ? signed(value) : digits(value)} \u00b1 ${digits(halfWidth)} ${unit}`;
  return make("span", { className: "quantity", textContent: text });
}

// Returns what a probe reads, as texts and elements.
export function readingOf(probe) {
  const isLux = "illuminance" in probe;
  const unit = isLux ? "lx" : "cd/m\u00b2";
  if (probe.state !== "read") return [states[probe.state] ?? probe.state];
  const value = isLux ? probe.illuminance : probe.luminance;
  const parts = [
    "least" in probe ? "mean " : "",
    quantity(value, probe.half_width, unit),
    probe.trusted ? " trusted" : " not trusted",
  ];
  if ("least" in probe) {
    const range = `${digits(probe.least)} to ${digits(probe.most)} ${unit}`;
    const uniformity = `uniformity ${digits(probe.uniformity)}`;
    for (const text of [range, uniformity])
      parts.push(", ", make("span", { className: "quantity", textContent: text }));
  }
  if ("change" in probe) {
    const isSame = probe.change === 0 && probe.change_half_width === 0;
    const verdict = probe.significant ? "significant" : isSame ? "unchanged" : "not yet certain";
    const change = quantity(probe.change, probe.change_half_width, unit, true);
    parts.push(", B - A: ", change, ` ${verdict}`);
  }
  return parts;
}

export class Light {
  // picture: has canvas and placeOf(event). edit: sends a command of the editor. isOpen: tells
  // whether the editor is open.
  constructor(stage, section, picture, { edit, isOpen }) {
    Object.assign(this, { stage, picture, edit, isOpen });
    this.state = { shown: "present", kept: false };
    this.part = 0.5; // of the picture that the wiper shows as A
    this.layOut(section);
    new ResizeObserver(() => this.place()).observe(stage);
    picture.canvas.addEventListener("pointermove", (event) => this.point(event));
    for (const kind of ["pointermove", "pointerdown", "pointerleave", "wheel"])
      picture.canvas.addEventListener(kind, (event) => this.rest(event), { passive: true });
  }

  layOut(section) {
    const button = (id, text, title, action) => {
      const one = make("button", { id, type: "button", textContent: text, title });
      one.addEventListener("click", action);
      return one;
    };
    const compare = (what) => () => this.edit("compare", { what });
    this.readings = make("ol", { id: "readings" });
    this.shows = {
      a: button("show-a", "A", "Show A in the place of the picture (\\)", compare("a")),
      wiper: button("show-wiper", "A | B", "Show A beside the picture (W)", compare("wiper")),
      difference: button("show-changes", "B - A", "Show what has changed since A (D)",
        compare("difference")),
    };
    const keep = () => this.edit("keep_probes");
    section.append(
      this.readings,
      button("keep", "Keep as A", "Compare what follows with the light of now (B)", keep),
      ...Object.values(this.shows),
      button("sensors", "Sensors", "Show the sensors of the file as probes", () =>
        this.edit("show_sensors"),
      ),
      button("table", "Table", "Download the probes as a table (CSV)", () =>
        this.edit("probe_table"),
      ),
      button("clear", "Clear", "Remove all probes", () => this.edit("clear_probes")),
    );
    this.cover = make("canvas", { id: "cover", hidden: true, label: "A" });
    this.wiper = make("div", { id: "wiper", hidden: true, tabIndex: 0, label: "Part of A" });
    this.wiper.setAttribute("role", "slider");
    this.wiper.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      this.wiper.focus();
      this.wiper.setPointerCapture(event.pointerId);
    });
    this.wiper.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) this.wipe((this.picture.placeOf(event).x + 1) / 2);
    });
    this.wiper.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 };
      if (!(event.key in steps)) return;
      event.preventDefault();
      event.stopPropagation();
      this.wipe(this.part + steps[event.key]);
    });
    this.legend = document.getElementById("legend");
    this.readout = make("div", { id: "readout", hidden: true });
    this.stage.append(this.readout);
    this.picture.canvas.after(this.cover); // below the handles
    this.stage.append(this.wiper);
  }

  wipe(part) {
    this.part = Math.max(0, Math.min(1, part));
    this.place();
  }

  // Puts A over the picture.
  place() {
    const area = areaOf(this.picture.canvas, this.stage);
    for (const side of ["left", "top", "width", "height"])
      this.cover.style[side] = `${area[side]}px`;
    const isWiped = this.state.shown === "wiper";
    this.cover.style.clipPath = isWiped ? `inset(0 ${(1 - this.part) * 100}% 0 0)` : "none";
    this.wiper.style.left = `${area.left + this.part * area.width}px`;
    this.wiper.style.top = `${area.top}px`;
    this.wiper.style.height = `${area.height}px`;
    this.wiper.setAttribute("aria-valuemin", 0);
    this.wiper.setAttribute("aria-valuemax", 100);
    this.wiper.setAttribute("aria-valuenow", Math.round(this.part * 100));
  }

  // Items stay while their readings change, so that their buttons can be pressed.
  onProbes(message) {
    const known = new Map([...this.readings.children].map((item) => [item.value, item]));
    const items = message.list.map((probe) => {
      const item = known.get(probe.number) ?? this.item(probe);
      item.firstChild.replaceChildren(...readingOf(probe));
      item.firstChild.title = probe.seen ?? "";
      const name = item.querySelector("input");
      if (document.activeElement !== name) name.value = probe.name ?? "";
      item.classList.toggle("uncertain", "change" in probe && !probe.significant);
      return item;
    });
    const isSame = items.length === known.size && items.every((one) => one.isConnected);
    if (!isSame) this.readings.replaceChildren(...items);
    for (const id of ["table", "clear"])
      document.getElementById(id).disabled = message.list.length === 0;
  }

  item(probe) {
    const name = this.nameField(probe.number);
    const item = make("li", { value: probe.number }, make("span"), " ", name);
    if (!probe.area) item.append(" ", this.keepButton(probe.number));
    return item;
  }

  nameField(probe) {
    const one = make("input", { label: `Name of probe ${probe}`, maxLength: 60 });
    one.placeholder = "name";
    one.addEventListener("change", () => this.edit("name_probe", { probe, name: one.value }));
    return one;
  }

  keepButton(probe) {
    const label = `Keep probe ${probe} in the world, as an ORTSensor`;
    const one = make("button", { type: "button", textContent: "\u2913", title: label, label });
    one.addEventListener("click", () => this.edit("keep_in_world", { probe }));
    return one;
  }

  onComparison(message) {
    const before = this.state.shown;
    this.state = message;
    document.body.dataset.shown = message.shown;
    for (const [what, button] of Object.entries(this.shows)) {
      button.disabled = !message.kept;
      button.setAttribute("aria-pressed", message.shown === what);
    }
    // Until its picture has come, there is nothing to be seen.
    if (message.shown !== before) this.cover.hidden = true;
    this.wiper.hidden = message.shown !== "wiper";
    this.legend.hidden = message.shown === "present";
    this.legend.replaceChildren(...this.legendOf(message));
    this.place();
  }

  legendOf(state) {
    const line = (text, name) => {
      const one = make("div", {}, text);
      if (name) one.prepend(make("span", { className: `key ${name}` }));
      return one;
    };
    if (state.shown === "a") return [line("A")];
    if (state.shown === "wiper") return [line("A at the left, B at the right of the line")];
    if (state.shown !== "difference") return [];
    if (!("most" in state)) return [line("B - A"), line("waits for a still picture")];
    const unit = "cd/m\u00b2";
    const most = state.most > 0 ? `, up to ${signed(state.most)} ${unit}` : ": none";
    const least = state.least < 0 ? `, down to ${signed(state.least)} ${unit}` : ": none";
    const here = state.here ? `${signed(state.here)} ${unit}` : "no significant change";
    const lines = [
      line("B - A"),
      line(`+ brighter${most}`, "gain"),
      line(`\u2212 darker${least}`, "loss"),
      line("no significant change (5 %, all pixels together)", "same"),
      line(
        `${state.significant} of ${state.pixels} pixels have changed; ` +
          `${state.pixels - state.judged} are not trusted`,
      ),
    ];
    if (!state.complete) lines.push(line("A was kept without all its samples"));
    if ("here" in state) lines.push(line(`here: ${here}`));
    return lines;
  }

  async onCover(message) {
    const bytes = Uint8Array.from(atob(message.image), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/jpeg" }));
    this.cover.width = bitmap.width;
    this.cover.height = bitmap.height;
    this.cover.getContext("2d", { alpha: false }).drawImage(bitmap, 0, 0);
    bitmap.close();
    this.cover.hidden = this.state.shown === "present";
    this.place();
  }

  // Asks for the change of light under the pointer, once for a frame of the page.
  point(event) {
    if (this.state.shown !== "difference") return;
    if (!this.waiting)
      requestAnimationFrame(() => {
        const { x, y } = this.waiting;
        this.waiting = null;
        if (Math.max(Math.abs(x), Math.abs(y)) <= 1) this.edit("point", { x, y });
      });
    this.waiting = this.picture.placeOf(event);
  }

  // The pointer has moved: nothing is read until it rests.
  rest(event) {
    clearTimeout(this.timer);
    if (this.resting) this.edit("point");
    this.resting = null;
    this.readout.hidden = true;
    if (event.type !== "pointermove" || event.buttons || !this.isOpen()) return;
    const { x, y } = this.picture.placeOf(event);
    if (this.state.shown !== "present" || Math.max(Math.abs(x), Math.abs(y)) > 1) return;
    this.timer = setTimeout(() => {
      this.resting = { x, y };
      this.edit("point", this.resting);
    }, restSeconds * 1000);
  }

  // Shows what is seen where the pointer rests, beside it and towards the middle.
  onPointer(message) {
    const { x, y } = this.resting ?? {};
    this.readout.hidden = !("seen" in message) || message.x !== x || message.y !== y;
    if (this.readout.hidden) return;
    const line = (...parts) => make("div", {}, ...parts);
    const wait = message.readable ? states.waiting : "V measures the light here";
    const isRead = "luminance" in message;
    const parts = isRead ? readingOf({ ...message, state: "read" }) : [wait];
    const lines = [line(...parts)];
    if (isRead)
      lines.push(
        line(
          "radiance",
          ...["R", "G", "B"].flatMap((name, i) => [
            ` ${name} `,
            quantity(message.radiance[i], message.radiance_half_width[i], ""),
          ]),
        ),
      );
    this.readout.replaceChildren(...lines, ...message.seen.split("\n").map((text) => line(text)));
    const area = areaOf(this.picture.canvas, this.stage);
    const left = area.left + ((1 + x) / 2) * area.width;
    const top = area.top + ((1 - y) / 2) * area.height;
    const gap = 14; // pixels
    const { style } = this.readout;
    style.left = x < 0 ? `${left + gap}px` : "auto";
    style.right = x < 0 ? "auto" : `${this.stage.clientWidth - left + gap}px`;
    style.top = y > 0 ? `${top + gap}px` : "auto";
    style.bottom = y > 0 ? "auto" : `${this.stage.clientHeight - top + gap}px`;
  }

  clear() {
    clearTimeout(this.timer);
    this.resting = null;
    this.readout.hidden = true;
    this.onComparison({ shown: "present", kept: false });
  }
}
