// page.js: The page of `vv serve`: shows the pictures that come through a WebSocket, and sends
// mouse, fingers and keys back. docs/serve.md lists the messages. Every text of the world is set as
// text, never as HTML.
"use strict";

const $ = (id) => document.getElementById(id);

// --- The connection ---

// Seconds until the next try after a lost connection; the last one is repeated.
const pauses = [0.5, 1, 2, 4, 8];

class Connection {
  constructor(onMessage, onPicture, onState) {
    this.handlers = { onMessage, onPicture, onState };
    this.tries = 0;
    this.open();
  }

  open() {
    clearTimeout(this.timer);
    this.timer = null;
    const address = new URL("live", location.href);
    address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
    address.search = "";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = () => {
      this.tries = 0;
      this.handlers.onState("connected");
    };
    this.socket.onmessage = (event) => {
      if (typeof event.data === "string") this.handlers.onMessage(JSON.parse(event.data));
      else this.handlers.onPicture(event.data);
    };
    this.socket.onclose = (event) => this.lost(event.reason);
  }

  lost(reason) {
    const pause = pauses[Math.min(this.tries++, pauses.length - 1)];
    this.handlers.onState("lost", reason, pause);
    this.timer = setTimeout(() => this.open(), pause * 1000);
  }

  // Tries again at once if the connection is lost.
  hurry() {
    if (this.timer) this.open();
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

// --- The picture ---

class Picture {
  constructor(canvas, acknowledge) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.acknowledge = acknowledge;
    this.facts = {};
    this.unacknowledged = 0;
    document.addEventListener("visibilitychange", () => this.answer());
  }

  // A picture is a length of 4 bytes, JSON of that length, and the bytes of a JPEG file.
  async show(data) {
    const length = new DataView(data).getUint32(0, true);
    const facts = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    this.unacknowledged = facts.picture;
    try {
      const file = new Blob([new Uint8Array(data, 4 + length)], { type: "image/jpeg" });
      const bitmap = await createImageBitmap(file);
      this.canvas.width = bitmap.width;
      this.canvas.height = bitmap.height;
      this.context.drawImage(bitmap, 0, 0);
      bitmap.close();
      this.facts = facts;
      this.canvas.dataset.picture = facts.picture;
      this.canvas.dataset.finished = facts.finished;
    } finally {
      this.answer();
    }
  }

  // Asks for the next picture. A page that nobody sees does not, and so gets none.
  answer() {
    if (!this.unacknowledged || document.hidden) return;
    this.acknowledge(this.unacknowledged);
    this.unacknowledged = 0;
  }

  // Returns a place of the page as x and y of the picture, from -1 to 1.
  placeOf(event) {
    const area = this.canvas.getBoundingClientRect();
    const scale = Math.min(area.width / this.canvas.width, area.height / this.canvas.height);
    const limit = (v) => Math.max(-100, Math.min(100, v));
    return {
      x: limit((event.clientX - area.left - area.width / 2) / ((this.canvas.width * scale) / 2)),
      y: limit((area.top + area.height / 2 - event.clientY) / ((this.canvas.height * scale) / 2)),
    };
  }
}

// --- Mouse and fingers ---

const buttons = ["left", "middle", "right"];
const notchPixels = 100; // of a wheel, in pixels, lines and pages
const notches = [1 / notchPixels, 1 / 3, 1];
const pinchNotches = 5; // of twice e as far: as far as that many notches of the wheel

class Pointing {
  constructor(canvas, picture, send) {
    this.canvas = canvas;
    this.picture = picture;
    this.send = send;
    this.fingers = new Map(); // places of the fingers that touch
    this.pair = null; // middle and distance of two fingers
    this.waiting = null; // the last move, which is sent with the next frame of the page
    for (const kind of ["pointerdown", "pointermove", "pointerup", "pointercancel", "pointerleave"])
      canvas.addEventListener(kind, (event) => this[kind](event));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    window.addEventListener("blur", () => this.leave());
  }

  modifiers(event) {
    return { shift: event.shiftKey, ctrl: event.ctrlKey, alt: event.altKey };
  }

  // The browser reports more moves than a picture can follow: one for each of its frames is sent.
  moveTo(place) {
    if (!this.waiting) requestAnimationFrame(() => this.flush());
    this.waiting = place;
  }

  flush() {
    if (this.waiting) this.send({ type: "move", ...this.waiting });
    this.waiting = null;
  }

  leave() {
    this.flush();
    this.fingers.clear();
    this.pair = null;
    this.send({ type: "leave" });
  }

  pointerdown(event) {
    this.canvas.focus();
    event.preventDefault();
    this.canvas.setPointerCapture(event.pointerId);
    this.flush();
    if (event.pointerType === "touch") {
      this.fingers.set(event.pointerId, event);
      if (this.fingers.size === 2) return this.beginPair();
      if (this.fingers.size > 2) return;
    }
    const place = this.picture.placeOf(event);
    if (!buttons[event.button]) return;
    this.send({ type: "press", button: buttons[event.button], ...place, ...this.modifiers(event) });
  }

  pointermove(event) {
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, event);
    if (this.pair) return this.movePair();
    // A second button that goes down or up while another is held comes as a move.
    if (event.button >= 0 && event.pointerType !== "touch" && buttons[event.button]) {
      this.flush();
      const held = event.buttons & [1, 4, 2][event.button];
      this.send({
        type: held ? "press" : "release",
        button: buttons[event.button],
        ...this.picture.placeOf(event),
        ...this.modifiers(event),
      });
      return;
    }
    this.moveTo(this.picture.placeOf(event));
  }

  pointerup(event) {
    this.flush();
    const paired = this.pair !== null;
    this.fingers.delete(event.pointerId);
    if (paired) return this.endPair();
    if (!buttons[event.button]) return;
    this.send({
      type: "release",
      button: buttons[event.button],
      ...this.picture.placeOf(event),
      ...this.modifiers(event),
    });
    if (event.pointerType === "touch") this.leave();
  }

  pointercancel() {
    this.leave();
  }

  pointerleave(event) {
    if (event.buttons === 0 && event.pointerType !== "touch") this.leave();
  }

  // Two fingers move the picture aside, as the right button does, and pinch as the wheel turns.
  pairNow() {
    const [a, b] = [...this.fingers.values()];
    return {
      clientX: (a.clientX + b.clientX) / 2,
      clientY: (a.clientY + b.clientY) / 2,
      distance: Math.max(1, Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY)),
    };
  }

  beginPair() {
    this.send({ type: "leave" }); // what the first finger has begun ends without a click
    this.pair = this.pairNow();
    this.send({ type: "press", button: "right", ...this.picture.placeOf(this.pair) });
  }

  movePair() {
    const now = this.pairNow();
    const amount = pinchNotches * Math.log(now.distance / this.pair.distance);
    if (Math.abs(amount) > 0.02) {
      this.send({ type: "wheel", amount });
      this.pair = now;
    }
    this.moveTo(this.picture.placeOf(now));
  }

  endPair() {
    this.send({ type: "release", button: "right", ...this.picture.placeOf(this.pair) });
    this.leave();
  }

  wheel(event) {
    event.preventDefault();
    this.flush();
    const amount = Math.max(-100, Math.min(100, -event.deltaY * notches[event.deltaMode]));
    if (amount) this.send({ type: "wheel", amount });
  }
}

// --- Keys ---

const arrows = { ArrowLeft: "Left", ArrowRight: "Right", ArrowUp: "Up", ArrowDown: "Down" };

// Returns vv's name of a key.
function nameOf(event) {
  if (arrows[event.key]) return arrows[event.key];
  if (event.key.length === 1) return event.key.toUpperCase();
  return event.key.length <= 16 ? event.key : "";
}

class Keys {
  // own: functions for the keys that the page handles itself. taken: tells whether vv knows a key.
  // typed: tells whether a sensor of the world takes what is typed.
  constructor(own, taken, typed, send) {
    const modifiers = (event) => ({
      // The key "!" is "!", with whatever keys it is typed.
      shift: event.shiftKey && (event.key.length > 1 || /[a-z]/i.test(event.key)),
      ctrl: event.ctrlKey,
      alt: event.altKey,
    });
    this.held = new Set();
    window.addEventListener("keydown", (event) => {
      const name = nameOf(event);
      if (this.isElsewhere(event) || event.metaKey || (event.ctrlKey && !arrows[event.key])) return;
      const types = typed() && /^[ -~]+$/.test(name) && !/^(F1|F11|Escape|Tab)$/.test(name);
      const action = types ? null : own[event.shiftKey ? `Shift+${name}` : name] || own[name];
      if (!types && !action && !taken(name)) return;
      event.preventDefault();
      if (action) return event.repeat || action();
      if (event.repeat && arrows[event.key]) return;
      this.held.add(name);
      send({ type: "down", key: name, ...modifiers(event) });
    });
    window.addEventListener("keyup", (event) => {
      const name = nameOf(event);
      if (!this.held.delete(name)) return;
      send({ type: "up", key: name, ...modifiers(event) });
    });
  }

  isElsewhere(event) {
    return $("panel").open || event.target instanceof HTMLSelectElement ||
      (event.target instanceof HTMLButtonElement && (event.key === " " || event.key === "Enter"));
  }
}

// --- The page ---

const levels = ["brief", "all", "none"];

class Page {
  constructor() {
    this.state = {};
    this.keys = [];
    this.mouse = [];
    this.known = new Set();
    this.level = 0;
    this.connection = new Connection(
      (message) => this[`on_${message.type}`]?.(message),
      (data) => this.picture.show(data),
      (...state) => this.onConnection(...state),
    );
    const send = (message) => this.connection.send(message);
    this.send = send;
    this.picture = new Picture($("picture"), (picture) => send({ type: "shown", picture }));
    this.pointing = new Pointing($("picture"), this.picture, send);
    const own = {
      S: () => this.save("png"),
      "Shift+S": () => this.save("exr"),
      C: () => send({ type: "command" }),
      I: () => this.nextLevel(),
      F1: () => this.showHelp(),
      "?": () => this.showHelp(),
      F11: () => this.toggleFullScreen(),
      Q: () => {}, // only the terminal ends vv
      Escape: () => this.giveUp(),
    };
    new Keys(own, (name) => this.known.has(name), () => this.state.keys, send);
    $("own").onclick = () => send({ type: this.state.role === "own" ? "follow" : "own" });
    $("png").onclick = () => this.save("png");
    $("exr").onclick = () => this.save("exr");
    $("command").onclick = () => send({ type: "command" });
    $("info").onclick = () => this.nextLevel();
    $("help").onclick = () => this.showHelp();
    $("viewpoints").onchange = (event) => {
      if (event.target.value !== "") send({ type: "viewpoint", number: Number(event.target.value) });
      $("picture").focus();
    };
    this.watchSize();
  }

  // Tells vv how many pixels of the device the picture has.
  watchSize() {
    let timer = null;
    const observer = new ResizeObserver((entries) => {
      const box = entries[0].devicePixelContentBoxSize?.[0];
      const content = entries[0].contentRect;
      this.size = {
        width: Math.max(1, Math.round(box ? box.inlineSize : content.width * devicePixelRatio)),
        height: Math.max(1, Math.round(box ? box.blockSize : content.height * devicePixelRatio)),
      };
      clearTimeout(timer);
      timer = setTimeout(() => this.send({ type: "size", ...this.size }), this.told ? 150 : 0);
      this.told = true;
    });
    try {
      observer.observe($("stage"), { box: "device-pixel-content-box" });
    } catch {
      observer.observe($("stage"));
    }
  }

  // --- Messages ---

  onConnection(state, reason, pause) {
    const lost = state === "lost";
    $("lost").hidden = !lost;
    $("picture").classList.toggle("old", lost);
    document.body.dataset.connection = state;
    if (lost) {
      const why = reason ? ` (${reason})` : "";
      $("lost").textContent = `The connection to vv is lost${why}. Trying again in ${pause} s ...`;
    } else {
      this.picture.unacknowledged = 0; // the new connection has its own count
      if (this.size) this.send({ type: "size", ...this.size });
    }
  }

  on_hello(message) {
    this.keys = message.keys;
    this.mouse = message.mouse;
    this.known = new Set(message.keys.flatMap(([keys]) => keys.split(" ")));
  }

  on_state(state) {
    this.state = state;
    document.title = `${state.world} - vv`;
    document.body.dataset.role = state.role;
    $("picture").classList.toggle("hand", state.hand);
    const roles = { leader: "You lead", follower: "Following", own: "Own view" };
    $("role").textContent = state.pages > 1 ? `${roles[state.role]}, ${state.pages} pages` : "";
    $("own").hidden = state.role === "leader";
    $("own").textContent = state.role === "own" ? "Follow" : "Own view";
    $("viewpoints").disabled = state.role === "follower";
    $("viewpoints").value = state.viewpoint >= 0 ? String(state.viewpoint) : "";
    if (!this.link) $("hint").textContent = state.bottom;
    this.showFacts();
  }

  on_viewpoints(message) {
    const entries = message.list.map((name, number) => new Option(name, String(number)));
    $("viewpoints").replaceChildren(new Option("Viewpoint", ""), ...entries);
    $("viewpoints").hidden = message.list.length === 0;
    $("viewpoints").value = this.state.viewpoint >= 0 ? String(this.state.viewpoint) : "";
  }

  on_command(message) {
    const line = document.createElement("pre");
    line.textContent = message.text;
    this.showPanel(line);
  }

  on_saved(message) {
    const link = document.createElement("a");
    link.href = message.path;
    link.download = message.name;
    link.click();
  }

  // A world may lead to any address: only those of the web are opened, and none can reach this page.
  on_open(message) {
    const address = new URL(message.url, "invalid:");
    if (address.protocol !== "http:" && address.protocol !== "https:") return;
    window.open(address.href, "_blank", "noopener,noreferrer");
    const link = document.createElement("a");
    link.href = address.href;
    link.target = "_blank";
    link.rel = "noopener noreferrer";
    link.textContent = address.href;
    $("hint").replaceChildren("The world leads to ", link);
    clearTimeout(this.link);
    this.link = setTimeout(() => {
      this.link = null;
      $("hint").textContent = this.state.bottom;
    }, 15000);
  }

  // --- Own actions ---

  save(format) {
    this.send({ type: "save", format });
  }

  // Gives up saving, which takes a while in worlds with much light.
  giveUp() {
    const key = { key: "Escape", shift: false, ctrl: false, alt: false };
    this.send({ type: "down", ...key });
    this.send({ type: "up", ...key });
  }

  nextLevel() {
    this.level = (this.level + 1) % levels.length;
    this.showFacts();
  }

  showFacts() {
    const lines = this.state.facts || [];
    const count = { none: 0, brief: 1, all: lines.length }[levels[this.level]];
    $("facts").textContent = lines.slice(0, count).join("\n");
  }

  showHelp() {
    const table = document.createElement("table");
    const fingers = [
      ["one finger", "as the left button"],
      ["two fingers", "aside, nearer and farther"],
    ];
    for (const [what, text] of [...this.keys, ...this.mouse, ...fingers]) {
      const row = table.insertRow();
      row.insertCell().textContent = what.replaceAll(" ", ", ");
      row.insertCell().textContent = text;
    }
    for (const row of [...table.rows].slice(this.keys.length))
      row.cells[0].textContent = row.cells[0].textContent.replaceAll(", ", " ");
    this.showPanel(table);
  }

  showPanel(content) {
    $("content").replaceChildren(content);
    if (!$("panel").open) $("panel").showModal();
  }

  toggleFullScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else $("stage").requestFullscreen();
  }
}

window.page = new Page();
document.addEventListener("visibilitychange", () => document.hidden || window.page.connection.hurry());
window.addEventListener("online", () => window.page.connection.hurry());
