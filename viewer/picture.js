// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Image of one plane, with the value under the pointer and a movable border to a second plane.

import {colourBar} from './colour_bar.js';
import {element} from './dom.js';
import {ValueBox} from './plot.js';

/**
 * Image of a plane. Content: {label, title, note, width, height, values, before: values to the left
 * of split() or null, colour(value) -> [r, g, b] or null, scale: colour bar or null, text(value,
 * index)}.
 */
export class Picture {
  #split = 0.5;

  constructor() {
    this.canvas = element('canvas', {role: 'img'});
    this.line = element('div', {class: 'split', hidden: true});
    this.node = element('div', {class: 'plot picture'}, this.canvas, this.line);
    this.caption = element('figcaption');
    this.scale = element('div');
    this.root = element('figure', {}, this.caption, this.node, this.scale);
    this.value = new ValueBox(this.node);
    this.node.addEventListener('pointermove', (event) => this.#point(event));
    this.node.addEventListener('pointerleave', () => this.value.hide());
  }

  /** Replaces the content. */
  show(spec) {
    this.spec = spec;
    this.canvas.width = spec.width;
    this.canvas.height = spec.height;
    this.canvas.setAttribute('aria-label', spec.label);
    this.caption.replaceChildren(
        element('span', {}, spec.title), element('small', {}, spec.note ?? ''));
    this.scale.replaceChildren(...(spec.scale ? [colourBar(spec.scale)] : []));
    this.after = this.#pixels(spec.values);
    this.before = spec.before ? this.#pixels(spec.before) : null;
    this.line.hidden = !this.before;
    this.split(this.#split);
  }

  /** Shows `before` in this share of the width, from the left. */
  split(share) {
    this.#split = share;
    const context = this.canvas.getContext('2d'), {width, height} = this.spec;
    context.putImageData(this.after, 0, 0);
    if (!this.before) return;
    context.putImageData(this.before, 0, 0, 0, 0, Math.round(share * width), height);
    this.line.style.left = `${100 * share}%`;
  }

  #pixels(values) {
    const {width, height, colour} = this.spec, image = new ImageData(width, height);
    for (let i = 0; i < width * height; ++i) {
      const shade = Number.isFinite(values[i]) ? colour(values[i], i) : null;
      if (!shade) continue;
      for (let c = 0; c < 3; ++c) image.data[4 * i + c] = shade[c];
      image.data[4 * i + 3] = 255;
    }
    return image;
  }

  #point(event) {
    if (!this.spec) return;
    const box = this.canvas.getBoundingClientRect(), {width, height, values, before} = this.spec;
    const column = Math.floor((event.clientX - box.left) / box.width * width);
    const row = Math.floor((event.clientY - box.top) / box.height * height);
    if (column < 0 || row < 0 || column >= width || row >= height) return;
    const i = row * width + column, isBefore = before && column < this.#split * width;
    this.value.show(
        event.clientX - box.left, event.clientY - box.top, `column ${column}, row ${row}`,
        this.spec.text((isBefore ? before : values)[i], i));
  }
}
