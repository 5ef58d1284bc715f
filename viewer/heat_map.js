// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Heat map: a table of coloured cells with their values as text.

import {colourBar} from './colour_bar.js';
import {cssColour, isDark} from './colours.js';
import {announce, drawn, drawSoon, element, onWidth, widthOf} from './dom.js';
import {axisOf, frameOf, innerOf, ValueBox} from './plot.js';

/**
 * Heat map that adapts to its width. Content: {label, columns, rows: texts of the ticks, values: in
 * row-major order, colour(value): [r, g, b] or null, cellText(value), details(column, row): lines,
 * titles: {x, y}, height, scale: colour bar or null, current: [column, row] or null,
 * choose(column, row) or null}.
 */
export class HeatMap {
  #spec = null;
  #cell = [0, 0];

  constructor() {
    this.node = element('div', {class: 'plot'});
    this.scale = element('div');
    this.root = element('div', {}, this.node, this.scale);
    this.value = new ValueBox(this.node);
    this.node.tabIndex = 0;
    this.node.setAttribute('role', 'application');
    this.node.addEventListener('keydown', (event) => this.#key(event));
    for (const gone of ['pointerleave', 'blur'])
      this.node.addEventListener(gone, () => this.value.hide());
    onWidth(this.node, () => this.#draw());
  }

  /** Replaces the content. */
  show(spec) {
    this.#spec = spec;
    this.node.setAttribute(
        'aria-label',
        `${spec.label}. Arrow keys read cells${spec.choose ? ', Enter selects one' : ''}.`);
    this.scale.replaceChildren(...(spec.scale ? [colourBar(spec.scale)] : []));
    drawSoon(this, () => this.#draw());
  }

  #draw() {
    const spec = this.#spec, width = widthOf(this.node);
    if (!spec || width < 20) return;
    const {columns, rows} = spec;
    const height = spec.height ?? Math.max(180, Math.min(420, 56 + 40 * rows.length));
    const left = Math.max(52, 34 + 6.6 * Math.max(...rows.map((text) => text.length)));
    const inner = innerOf(width, height, {left});
    const cellWidth = (inner.x[1] - inner.x[0]) / columns.length;
    const x = axisOf(levels(columns, cellWidth), inner.x, 0);
    const y = axisOf(levels(rows, Infinity), inner.y, 0);
    const cells = drawn('g', {});
    const [w, h] = [x.at(1) - x.at(0), y.at(0) - y.at(1)];
    rows.forEach((_, r) => columns.forEach((_, c) => {
      const value = spec.values[r * columns.length + c], colour = spec.colour(value);
      cells.append(drawn('rect', {
        class: `cell${spec.current?.[0] === c && spec.current[1] === r ? ' current' : ''}${
            spec.choose ? ' chosen' : ''}`,
        x: x.at(c) - w / 2,
        y: y.at(r) - h / 2,
        width: w,
        height: h,
        style: `fill:${colour ? cssColour(colour) : 'var(--faint)'}`,
        onclick: () => spec.choose?.(c, r),
        onpointermove: () => this.#read(c, r)
      }));
      const text = colour ? spec.cellText(value) : '';
      if (w > 6 + 6.5 * text.length && h > 13)
        cells.append(drawn(
            'text', {
              class: 'cell-text',
              x: x.at(c),
              y: y.at(r) + 4,
              'text-anchor': 'middle',
              style: `fill:${isDark(colour ?? [255, 255, 255]) ? '#fff' : '#111'}`
            },
            text));
    }));
    this.at = (c, r) => [x.at(c), y.at(r)];
    this.svg?.remove();
    this.svg = drawn(
        'svg', {viewBox: `0 0 ${width} ${height}`, height, 'aria-hidden': 'true'},
        frameOf(x, y, spec.titles, width, height, {left}), cells);
    this.node.prepend(this.svg);
  }

  #read(c, r) {
    this.#cell = [c, r];
    const lines = this.#spec.details(c, r);
    this.value.show(...this.at(c, r), ...lines);
    return lines;
  }

  #key(event) {
    const spec = this.#spec;
    if (!spec) return;
    if (spec.choose && (event.key === 'Enter' || event.key === ' ')) {
      event.preventDefault();
      spec.choose(...this.#cell);
      return;
    }
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [
                    0, -1
                  ]}[event.key];
    if (!step) return;
    event.preventDefault();
    const within = (value, list) => Math.min(list.length - 1, Math.max(0, value));
    announce(this.#read(
                     within(this.#cell[0] + step[0], spec.columns),
                     within(this.#cell[1] + step[1], spec.rows))
                 .join(', '));
  }
}

/** Returns an axis of names; if space is limited, only every n-th name. */
function levels(texts, room) {
  const wide = 10 + 6.2 * Math.max(...texts.map((text) => text.length));
  const step = Math.max(1, Math.ceil(Number.isFinite(room) ? wide / room : texts.length / 12));
  return {
    range: [-0.5, texts.length - 0.5],
    ticks: texts.map((text, value) => ({value, text: value % step === 0 ? text : ''}))
  };
}
