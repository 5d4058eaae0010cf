// thumbnails.js: Small pictures of the texture nodes that the fields of the selected node show.
"use strict";

import { make } from "./fields.js";

export class Thumbnails {
  constructor() {
    this.known = new Map(); // bitmaps with their scale, or why there is none, by node
    this.places = new Set();
  }

  // Returns an element that shows the picture of a node once it is known.
  placeOf(node) {
    const place = make("div", { className: "thumbnail" });
    place.dataset.node = node;
    this.places.add(place);
    this.fill(place);
    return place;
  }

  fill(place) {
    const known = this.known.get(Number(place.dataset.node));
    place.hidden = !known;
    if (!known) return place.replaceChildren();
    if (known.error) return place.replaceChildren(`no picture: ${known.error}`);
    const { bitmap, scale } = known;
    // The name of the node says what it is.
    const canvas = make("canvas", { width: bitmap.width, height: bitmap.height });
    canvas.setAttribute("aria-hidden", "true");
    canvas.style.width = `${bitmap.width * scale}px`;
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    place.replaceChildren(canvas);
  }

  async onThumbnails(message) {
    this.message = message;
    const pictures = await Promise.all(message.list.map((one) => this.read(one)));
    if (this.message !== message) return; // a later one has come
    this.known = new Map(message.list.map(({ node }, i) => [node, pictures[i]]));
    for (const place of this.places)
      if (place.isConnected) this.fill(place);
      else this.places.delete(place);
  }

  async read({ image, scale, error }) {
    if (error) return { error };
    const bytes = Uint8Array.from(atob(image), (c) => c.charCodeAt(0));
    return { bitmap: await createImageBitmap(new Blob([bytes], { type: "image/png" })), scale };
  }
}
