// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Lines over axes, with legend and values under the pointer or the arrow keys.

import {announce, drawn, drawSoon, element, onWidth, widthOf} from './dom.js';
import {linearTicks, logarithmicTicks, shortText} from './numbers.js';

/** One axis: from values to pixels, and its ticks. */
export function axisOf({range: [low, high], log = false, ticks = null}, [from, to], count) {
  const place =
      log ? (v) => Math.log10(v / low) / Math.log10(high / low) : (v) => (v - low) / (high - low);
  const back = log ? (p) => low * (high / low) ** p : (p) => low + p * (high - low);
  return {
    low,
    high,
    log,
    at: (value) => from + place(value) * (to - from),
    value: (pixel) => back((pixel - from) / (to - from)),
    ticks: ticks ?? (log ? logarithmicTicks(low, high) : linearTicks(low, high, count)),
  };
}

/** An axis range with room around what is shown. */
export function paddedRange([low, high], log = false) {
  if (log) {
    const room = Math.max((high / low) ** 0.06, 1.02);
    return [low / room, high * room];
  }
  const room = high > low ? 0.06 * (high - low) : Math.abs(high) / 2 || 1;
  return [low - room, high + room];
}

/** A box in the plot that shows a value near a point of it. */
export class ValueBox {
  constructor(plot) {
    this.plot = plot;
    this.box = element('div', {class: 'value', hidden: true});
    plot.append(this.box);
  }

  /** Shows lines of text or elements beside (x, y) in pixels of the plot. */
  show(x, y, ...lines) {
    this.box.replaceChildren(...lines.map((line) => element('div', {}, line)));
    this.box.hidden = false;
    const width = this.plot.clientWidth, own = this.box.offsetWidth;
    this.box.style.left = `${Math.max(0, x + 12 + own > width ? x - own - 12 : x + 12)}px`;
    this.box.style.top = `${Math.max(0, y - this.box.offsetHeight / 2)}px`;
  }

  hide() {
    this.box.hidden = true;
  }
}

const margin = {
  left: 66,
  right: 12,
  top: 8,
  bottom: 40
};

/** The frame of a plot: grid, ticks and titles of both axes. */
export function frameOf(x, y, titles, width, height) {
  const [left, right, top, bottom] =
      [margin.left, width - margin.right, margin.top, height - margin.bottom];
  const parts = [];
  for (const {value, text} of x.ticks) {
    parts.push(
        drawn('line', {class: 'grid', x1: x.at(value), x2: x.at(value), y1: top, y2: bottom}));
    if (text)
      parts.push(drawn(
          'text', {class: 'tick', x: x.at(value), y: bottom + 15, 'text-anchor': 'middle'}, text));
  }
  for (const {value, text} of y.ticks) {
    parts.push(
        drawn('line', {class: 'grid', x1: left, x2: right, y1: y.at(value), y2: y.at(value)}));
    if (text)
      parts.push(drawn(
          'text', {class: 'tick', x: left - 6, y: y.at(value) + 4, 'text-anchor': 'end'}, text));
  }
  parts.push(
      drawn('path', {class: 'frame', d: `M${left},${top}V${bottom}H${right}`}),
      drawn(
          'text',
          {class: 'axis-title', x: (left + right) / 2, y: height - 6, 'text-anchor': 'middle'},
          titles.x),
      drawn(
          'text', {
            class: 'axis-title',
            transform: `translate(12 ${(top + bottom) / 2}) rotate(-90)`,
            'text-anchor': 'middle'
          },
          titles.y));
  return drawn('g', {}, ...parts);
}

/** The inner rectangle of a plot of this size, for axes. */
export const innerOf = (width, height) =>
    ({x: [margin.left, width - margin.right], y: [height - margin.bottom, margin.top]});

function pathOf(series, x, y) {
  let path = '', pen = 'M';
  for (let i = 0; i < series.x.length; ++i) {
    const value = series.y[i];
    if (!Number.isFinite(value) || (y.log && value <= 0)) {
      pen = 'M';
      continue;
    }
    const py = Math.min(1e5, Math.max(-1e5, y.at(value)));
    path += `${pen}${x.at(series.x[i]).toFixed(1)},${py.toFixed(1)}`;
    pen = 'L';
  }
  return path;
}

function bandOf({x: places, band: [low, high]}, x, y) {
  const floor = (v) => (y.log ? Math.max(v, y.low / 10) : v);
  const at = (i, v) => `${x.at(places[i]).toFixed(1)},${y.at(floor(v)).toFixed(1)}`;
  const there = Array.from(places, (_, i) => at(i, high[i]));
  const back = Array.from(places, (_, i) => at(i, low[i])).reverse();
  return `M${there.concat(back).join('L')}Z`;
}

function legendOf(series) {
  const sample = ({colour, dash}) =>
      drawn('svg', {viewBox: '0 0 24 10', 'aria-hidden': 'true'}, drawn('line', {
              x1: 0,
              x2: 24,
              y1: 5,
              y2: 5,
              'stroke-width': 2.5,
              'stroke-dasharray': dash || null,
              style: `stroke:${colour}`
            }));
  return element(
      'ul', {class: 'legend'}, ...series.map((one) => element('li', {}, sample(one), one.name)));
}

/**
 * A plot of lines that follows its width.
 *
 * What it shows: {label, height, x: {title, range, log, unit, text}, y: {..}, series: [{name, x, y,
 * colour, dash, width, band: [low, high]}], legend, valueText}.
 */
export class LinePlot {
  #spec = null;
  #index = null;

  constructor() {
    this.node = element('div', {class: 'plot'});
    this.legend = element('div');
    this.root = element('div', {}, this.legend, this.node);
    this.value = new ValueBox(this.node);
    this.node.tabIndex = 0;
    this.node.setAttribute('role', 'img');
    this.node.addEventListener('keydown', (event) => this.#key(event));
    this.node.addEventListener('pointermove', (event) => this.#point(event));
    for (const gone of ['pointerleave', 'blur'])
      this.node.addEventListener(gone, () => this.#leave());
    onWidth(this.node, () => this.#draw());
  }

  /** Shows something else. */
  show(spec) {
    this.#spec = spec;
    this.node.setAttribute('aria-label', `${spec.label}. Arrow keys read values.`);
    const names = JSON.stringify(spec.series.map((one) => [one.name, one.colour, one.dash]));
    if (names !== this.names) this.legend.replaceChildren(legendOf(spec.series));
    this.names = names;
    drawSoon(this, () => this.#draw());
  }

  #draw() {
    const spec = this.#spec, width = widthOf(this.node);
    if (!spec || width < 20) return;
    const height = spec.height ?? 260, inner = innerOf(width, height);
    this.x = axisOf(spec.x, inner.x, Math.max(2, Math.floor(width / 90)));
    this.y = axisOf(spec.y, inner.y, Math.max(2, Math.floor(height / 55)));
    const inside = drawn('g', {});
    for (const one of spec.series)
      if (one.band)
        inside.append(drawn(
            'path', {d: bandOf(one, this.x, this.y), style: `fill:${one.colour}`, opacity: 0.18}));
    for (const one of spec.series)
      inside.append(drawn('path', {
        class: 'curve',
        d: pathOf(one, this.x, this.y),
        'stroke-width': one.width ?? 1.8,
        'stroke-dasharray': one.dash || null,
        style: `stroke:${one.colour}`
      }));
    this.cursor =
        drawn('line', {class: 'cursor', y1: inner.y[1], y2: inner.y[0], visibility: 'hidden'});
    this.svg?.remove();
    this.svg = drawn(
        'svg', {viewBox: `0 0 ${width} ${height}`, height, 'aria-hidden': 'true'},
        frameOf(this.x, this.y, {x: spec.x.title, y: spec.y.title}, width, height), inside,
        this.cursor);
    this.node.prepend(this.svg);
    this.#index = null;
    this.value.hide();
  }

  #leave() {
    this.#index = null;
    this.value.hide();
    this.cursor?.setAttribute('visibility', 'hidden');
  }

  #point(event) {
    if (!this.#spec?.series.length || !this.x) return;
    const places = this.#spec.series[0].x,
          pixel = event.clientX - this.node.getBoundingClientRect().left;
    let best = 0;
    for (let i = 1; i < places.length; ++i)
      if (Math.abs(this.x.at(places[i]) - pixel) < Math.abs(this.x.at(places[best]) - pixel))
        best = i;
    this.#read(best);
  }

  #key(event) {
    const step =
        {ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10, Home: -1e9, End: 1e9}[event.key];
    if (step === undefined || !this.#spec?.series.length) return;
    event.preventDefault();
    const last = this.#spec.series[0].x.length - 1;
    this.#read(Math.min(
        last, Math.max(0, this.#index === null ? (step < 0 ? last : 0) : this.#index + step)));
    announce(this.said);
  }

  #read(i) {
    this.#index = i;
    const {x, y, series} = this.#spec;
    const text = (axis, value) =>
        (axis.text ?? ((v) => `${shortText(v)}${axis.unit ? ' ' + axis.unit : ''}`))(value);
    const place = series[0].x[i], at = this.x.at(place);
    const lines = series.filter((one) => !one.isSilent).slice(0, 12).map((one) => {
      const name = element('span');
      name.append(
          element('i', {style: `background:${one.colour}`}), `${one.name}: ${text(y, one.y[i])}`);
      return name;
    });
    this.cursor.setAttribute('x1', at);
    this.cursor.setAttribute('x2', at);
    this.cursor.setAttribute('visibility', 'visible');
    this.said = [text(x, place), ...lines.map((line) => line.textContent)].join(', ');
    this.value.show(at, this.node.clientHeight / 3, text(x, place), ...lines);
  }
}
