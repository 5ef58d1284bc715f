// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Horizontal bars by category; dots on a logarithmic axis, where the length of a bar has no meaning.

import {drawn, drawSoon, element, onWidth, widthOf} from './dom.js';
import {shortText} from './numbers.js';
import {axisOf} from './plot.js';

const barHeight = 13, gap = 9, top = 4, bottom = 40, letter = 6.6;

/**
 * A bar chart that follows its width. What it shows: {label, categories, series: [{name, values,
 * errors, colours: one of each category}], axis: {title, range, log, unit}}.
 */
export class BarPlot {
  #spec = null;

  constructor() {
    this.node = element('div', {class: 'plot', role: 'img'});
    this.root = this.node;
    onWidth(this.node, () => this.#draw());
  }

  show(spec) {
    this.#spec = spec;
    this.node.setAttribute('aria-label', spec.label);
    drawSoon(this, () => this.#draw());
  }

  #draw() {
    const spec = this.#spec, width = widthOf(this.node);
    if (!spec || width < 20) return;
    const {categories, series, axis} = spec, row = series.length * barHeight + gap;
    const longest = Math.max(...categories.map((text) => text.length));
    const left = Math.min(0.45 * width, 10 + letter * longest), right = width - 58;
    const height = top + row * categories.length + bottom, floor = height - bottom;
    const x = axisOf(axis, [left, right], Math.max(2, Math.floor((right - left) / 90)));
    const svg = drawn('svg', {viewBox: `0 0 ${width} ${height}`, height, 'aria-hidden': 'true'});
    for (const {value, text} of x.ticks) {
      svg.append(
          drawn('line', {class: 'grid', x1: x.at(value), x2: x.at(value), y1: top, y2: floor}),
          drawn(
              'text', {class: 'tick', x: x.at(value), y: floor + 15, 'text-anchor': 'middle'},
              text));
    }
    svg.append(
        drawn('path', {class: 'frame', d: `M${left},${top}V${floor}H${right}`}),
        drawn(
            'text',
            {class: 'axis-title', x: (left + right) / 2, y: height - 6, 'text-anchor': 'middle'},
            axis.title));
    categories.forEach((category, c) => {
      const y = top + c * row + gap / 2, most = Math.floor((left - 8) / letter);
      svg.append(drawn(
          'text', {x: left - 7, y: y + series.length * barHeight / 2 + 4, 'text-anchor': 'end'},
          category.length > most ? `${category.slice(0, most - 1)}\u2026` : category,
          drawn('title', {}, category)));
      series.forEach((one, s) => this.#bar(svg, x, one, c, y + s * barHeight));
    });
    this.svg?.remove();
    this.svg = svg;
    this.node.append(svg);
  }

  #bar(svg, x, {name, values, errors, colours}, c, y) {
    const value = values[c], middle = y + barHeight / 2, fill = `fill:${colours[c]}`;
    if (!Number.isFinite(value) || (x.log && value <= 0)) return;
    const error = errors?.[c] > 0 ? errors[c] : 0, at = x.at(value);
    const shape = x.log ?
        drawn('circle', {cx: at, cy: middle, r: 4, style: fill}) :
        drawn('rect', {
          x: Math.min(x.at(0), at),
          y: y + 1,
          width: Math.max(1, Math.abs(at - x.at(0))),
          height: barHeight - 2,
          rx: 2,
          style: fill
        });
    const text = shortText(value, 3), unit = this.#spec.axis.unit ? ` ${this.#spec.axis.unit}` : '';
    shape.append(drawn('title', {}, `${name}: ${text}${unit}`));
    svg.append(shape);
    const end = x.at(value + error);
    if (error)
      svg.append(drawn('path', {
        class: 'whisker error',
        d: `M${x.at(Math.max(value - error, x.log ? value / 10 : x.low))},${middle}H${end}`
      }));
    svg.append(drawn('text', {class: 'tick', x: Math.max(end, at) + 6, y: middle + 4}, text));
  }
}
