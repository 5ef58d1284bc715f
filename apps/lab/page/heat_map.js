// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A map of values over two lists of levels: one rectangle a pair, its value in it.

import {cssColour, isDark, scaleGradient, sequentialColour} from './colours.js';
import {announce, drawn, drawSoon, element, onWidth, widthOf} from './dom.js';
import {rateText} from './numbers.js';
import {axisOf, frameOf, innerOf, ValueBox} from './plot.js';

const place = (value, [low, high]) =>
    (high > low ? Math.log(value / low) / Math.log(high / low) : 0.5);

/** The strip of colours under a picture, with its ends. */
export function colourBar(low, high, colour, title) {
  return element(
      'div', {class: 'scale', title}, element('span', {}, low),
      element('i', {style: `background:${scaleGradient(colour)}`}), element('span', {}, high));
}

/**
 * A heat map on two logarithmic axes that follows its width. What it shows: {label, columns, rows:
 * levels, values: rows after rows, range: [low, high] of the colours, text(value), details(column,
 * row): lines, titles: {x, y}, current: [column, row] or null, choose(column, row)}.
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

  /** Shows something else. */
  show(spec) {
    this.#spec = spec;
    this.node.setAttribute(
        'aria-label',
        `${spec.label}. Arrow keys read cells, Enter takes a cell's light for the scene.`);
    const ends = spec.range.map(spec.text);
    this.scale.replaceChildren(colourBar(ends[0], ends[1], sequentialColour, 'depth error'));
    drawSoon(this, () => this.#draw());
  }

  #draw() {
    const spec = this.#spec, width = widthOf(this.node);
    if (!spec || width < 20) return;
    const {columns, rows} = spec, height = Math.max(180, Math.min(300, 56 + 40 * rows.length)),
                    inner = innerOf(width, height);
    const levels = (list) => ({range: [-0.5, list.length - 0.5], ticks: levelTicks(list)});
    const x = axisOf(levels(columns), inner.x, 0), y = axisOf(levels(rows), inner.y, 0);
    const cells = drawn('g', {});
    const [w, h] = [x.at(1) - x.at(0), y.at(0) - y.at(1)];
    rows.forEach((_, r) => columns.forEach((_, c) => {
      const value = spec.values[r * columns.length + c], known = value > 0;
      const colour = sequentialColour(known ? place(value, spec.range) : 0);
      cells.append(drawn('rect', {
        class: `cell${spec.current?.[0] === c && spec.current[1] === r ? ' current' : ''}`,
        x: x.at(c) - w / 2,
        y: y.at(r) - h / 2,
        width: w,
        height: h,
        style: `fill:${known ? cssColour(colour) : 'var(--faint)'}`,
        onclick: () => spec.choose(c, r),
        onpointermove: () => this.#read(c, r)
      }));
      if (w > 34 && h > 13)
        cells.append(drawn(
            'text', {
              class: 'cell-text',
              x: x.at(c),
              y: y.at(r) + 4,
              'text-anchor': 'middle',
              style: `fill:${isDark(colour) ? '#fff' : '#111'}`
            },
            spec.text(value).replace(/ m?m$/, '')));
    }));
    this.at = (c, r) => [x.at(c), y.at(r)];
    this.svg?.remove();
    this.svg = drawn(
        'svg', {viewBox: `0 0 ${width} ${height}`, height, 'aria-hidden': 'true'},
        frameOf(x, y, spec.titles, width, height), cells);
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
    if (event.key === 'Enter' || event.key === ' ') {
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

function levelTicks(levels) {
  const step = Math.ceil(levels.length / 8);
  return levels.map((level, value) => ({value, text: value % step === 0 ? rateText(level) : ''}));
}
