// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A plane of a picture as pixels, its value under the pointer.

import {element} from './dom.js';
import {colourBar} from './heat_map.js';
import {ValueBox} from './plot.js';

/**
 * One plane. What it shows: {label, title, note, width, height, values, colour(value) -> [r, g, b]
 * or null, ends: [low, high] texts, gradient(place), text(value, index)}.
 */
export class Picture {
  constructor() {
    this.canvas = element('canvas', {role: 'img'});
    this.node = element('div', {class: 'plot picture'}, this.canvas);
    this.caption = element('figcaption');
    this.scale = element('div');
    this.root = element('figure', {}, this.caption, this.node, this.scale);
    this.value = new ValueBox(this.node);
    this.node.addEventListener('pointermove', (event) => this.#point(event));
    this.node.addEventListener('pointerleave', () => this.value.hide());
  }

  /** Shows something else. */
  show(spec) {
    this.spec = spec;
    const {width, height, values} = spec;
    this.canvas.width = width;
    this.canvas.height = height;
    this.canvas.setAttribute('aria-label', spec.label);
    const context = this.canvas.getContext('2d'), image = context.createImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
      const colour = Number.isFinite(values[i]) ? spec.colour(values[i], i) : null;
      if (colour) image.data.set([...colour, 255], 4 * i);
    }
    context.putImageData(image, 0, 0);
    this.caption.replaceChildren(spec.title, element('small', {}, spec.note ?? ''));
    this.scale.replaceChildren(colourBar(spec.ends[0], spec.ends[1], spec.gradient, spec.title));
  }

  #point(event) {
    if (!this.spec) return;
    const box = this.canvas.getBoundingClientRect(), {width, height, values} = this.spec;
    const column = Math.floor((event.clientX - box.left) / box.width * width);
    const row = Math.floor((event.clientY - box.top) / box.height * height);
    if (column < 0 || row < 0 || column >= width || row >= height) return;
    const i = row * width + column;
    this.value.show(
        event.clientX - box.left, event.clientY - box.top, `column ${column}, row ${row}`,
        this.spec.text(values[i], i));
  }
}
