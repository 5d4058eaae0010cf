// importer.js: Files that are dropped on the editor or chosen, one after the other: vv writes each
// into the folder of the world's file and adds it as an Inline.
"use strict";

import { make } from "./fields.js";

const partsAhead = 4; // parts that are on their way at a time

export class Importer {
  // edit: sends a command of the editor. say: tells the user something. isOpen: tells whether the
  // editor is open.
  constructor(edit, say, isOpen) {
    Object.assign(this, { edit, say });
    this.waiting = [];
    this.file = null; // the one that is being sent
    this.input = make("input", { type: "file", multiple: true, hidden: true, label: "Files" });
    document.body.append(this.input);
    this.input.addEventListener("change", () => {
      this.take(this.input.files);
      this.input.value = ""; // so that the same file can be chosen again
    });
    for (const kind of ["dragover", "drop"])
      window.addEventListener(kind, (event) => {
        if (!isOpen() || !event.dataTransfer?.types.includes("Files")) return;
        event.preventDefault();
        if (kind === "drop") this.take(event.dataTransfer.files);
      });
  }

  choose() {
    this.input.click();
  }

  take(files) {
    this.waiting.push(...files);
    if (!this.file) this.next();
  }

  next() {
    this.file = this.waiting.shift() ?? null;
    if (!this.file) return;
    const { name, size } = this.file;
    this.sent = this.received = 0;
    this.hasBegun = false;
    if (size > this.mostFileBytes) {
      this.say(`${name} has more than ${this.mostFileBytes} bytes (maxImportBytes)`, true);
      return this.next();
    }
    this.edit("import", { name: name.slice(-200), bytes: size });
  }

  // vv says what has come. Without bytes it has used or refused the file.
  onImport(message) {
    if (!this.file) return;
    if (message.bytes === 0) return this.next();
    this.received = message.received;
    this.send();
  }

  async send() {
    if (this.isSending) return;
    this.isSending = true;
    const { file } = this;
    while (file === this.file && this.sent < file.size && this.isNear()) {
      const part = file.slice(this.sent, this.sent + this.partBytes);
      this.sent += part.size;
      const data = await this.textOf(part);
      if (file !== this.file) break;
      if (data === null) return this.fail();
      this.edit("import_part", { data });
    }
    this.isSending = false;
  }

  isNear() {
    return this.sent - this.received < partsAhead * this.partBytes;
  }

  // Returns the bytes of a part in base64; null: they cannot be read.
  textOf(part) {
    return new Promise((resolve) => {
      const reader = new FileReader();
      reader.onload = () => resolve(reader.result.slice(reader.result.indexOf(",") + 1));
      reader.onerror = () => resolve(null);
      reader.readAsDataURL(part);
    });
  }

  fail() {
    this.isSending = false;
    this.say(`${this.file.name} cannot be read`, true);
    this.next(); // vv forgets the one before
  }

  // limits: those of the editor's first message.
  begin(limits) {
    this.mostFileBytes = limits.mostFileBytes;
    this.partBytes = Math.floor((limits.mostBytes - 200) / 4) * 3;
  }

  // The connection is lost.
  clear() {
    this.waiting = [];
    this.file = null;
    this.isSending = false;
  }
}
