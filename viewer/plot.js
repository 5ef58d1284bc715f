// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Line plots with a legend and values that the pointer or the arrow keys select.

import {announce, drawn, drawSoon, element, onWidth, widthOf} from './dom.js';
import {linearTicks, logarithmicTicks, shortText} from './numbers.js';

let clips = 0;  // number of clip paths, for their ids

/** Returns an axis: its mapping between values and pixels, and its ticks. */
export function axisOf(
    {range: [low, high], log = false, ticks = null, isWhole = false}, [from, to], count) {
  const most = isWhole ? Math.min(count, high - low) : count;
  const place =
      log ? (v) => Math.log10(v / low) / Math.log10(high / low) : (v) => (v - low) / (high - low);
  const back = log ? (p) => low * (high / low) ** p : (p) => low + p * (high - low);
  return {
    low,
    high,
    log,
    at: (value) => from + place(value) * (to - from),
    value: (pixel) => back((pixel - from) / (to - from)),
    ticks: ticks ?? (log ? logarithmicTicks(low, high) : linearTicks(low, high, most)),
  };
}

/** Returns an axis range with padding around the data. */
export function paddedRange([low, high], log = false) {
  if (log) {
    const room = Math.max((high / low) ** 0.06, 1.02);
    return [low / room, high * room];
  }
  const room = high > low ? 0.06 * (high - low) : Math.abs(high) / 2 || 1;
  return [low - room, high + room];
}

/** Box that shows a value next to a point of a plot. */
export class ValueBox {
  constructor(plot) {
    this.plot = plot;
    this.box = element('div', {class: 'value', hidden: true});
    plot.append(this.box);
  }

  /** Shows lines of text or elements next to (x, y), in pixels of the plot. */
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

/** Returns the margins of a plot, which are narrower in a grid or without a title. */
const marginsOf = ({isCompact, isBare, left}) =>
    ({...margin, left: left ?? (isCompact ? 50 : margin.left), bottom: isBare ? 8 : margin.bottom});

/** Returns grid, ticks and titles of both axes. `layout`: see marginsOf. */
export function frameOf(x, y, titles, width, height, layout = {}) {
  const room = marginsOf(layout);
  const [left, right, top, bottom] =
      [room.left, width - room.right, room.top, height - room.bottom];
  const parts = [];
  for (const {value, text} of x.ticks) {
    parts.push(
        drawn('line', {class: 'grid', x1: x.at(value), x2: x.at(value), y1: top, y2: bottom}));
    if (text && !layout.isBare)
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
  parts.push(drawn('path', {class: 'frame', d: `M${left},${top}V${bottom}H${right}`}));
  if (titles.x && !layout.isBare)
    parts.push(drawn(
        'text',
        {class: 'axis-title', x: (left + right) / 2, y: height - 6, 'text-anchor': 'middle'},
        titles.x));
  if (titles.y)
    parts.push(drawn(
        'text', {
          class: 'axis-title',
          transform: `translate(12 ${(top + bottom) / 2}) rotate(-90)`,
          'text-anchor': 'middle'
        },
        titles.y));
  return drawn('g', {}, ...parts);
}

/** Returns the inner rectangle of a plot of this size, for axes. */
export function innerOf(width, height, layout = {}) {
  const room = marginsOf(layout);
  return {x: [room.left, width - room.right], y: [height - room.bottom, room.top]};
}

const isShown = (value, axis) => Number.isFinite(value) && !(axis.log && value <= 0);
const heightOf = (value, y) => Math.min(1e5, Math.max(-1e5, y.at(value)));

function pathOf(series, x, y) {
  let path = '', pen = 'M';
  for (let i = 0; i < series.x.length; ++i) {
    if (!isShown(series.y[i], y) || !isShown(series.x[i], x)) {
      pen = 'M';
      continue;
    }
    const at = x.at(series.x[i]).toFixed(1), up = heightOf(series.y[i], y).toFixed(1);
    path += series.mark === 'steps' && pen === 'L' ? `H${at}V${up}` : `${pen}${at},${up}`;
    pen = 'L';
  }
  return path;
}

// Markers of dashed series are rings, through which coinciding markers are visible.
const markStyle = ({colour, dash}) => `stroke:${colour};fill:${dash ? 'none' : colour}`;

/** Returns the markers of a series with error bars. */
function marksOf(series, x, y) {
  const marks = [], style = markStyle(series);
  for (let i = 0; i < series.x.length; ++i) {
    if (!isShown(series.y[i], y) || !isShown(series.x[i], x)) continue;
    const at = x.at(series.x[i]), error = series.error?.[i];
    if (error > 0) {
      const low = y.log ? Math.max(series.y[i] - error, series.y[i] / 100) : series.y[i] - error;
      marks.push(drawn('path', {
        class: 'whisker',
        d: `M${at},${heightOf(low, y)}V${heightOf(series.y[i] + error, y)}`,
        style: `stroke:${series.colour}`
      }));
    }
    if (/markers/.test(series.mark))
      marks.push(drawn('circle', {cx: at, cy: heightOf(series.y[i], y), r: 3, style}));
  }
  return marks;
}

function bandOf({x: places, band: [low, high]}, x, y) {
  const floor = (v) => (y.log ? Math.max(v, y.low / 10) : v);
  const at = (i, v) => `${x.at(places[i]).toFixed(1)},${y.at(floor(v)).toFixed(1)}`;
  const there = Array.from(places, (_, i) => at(i, high[i]));
  const back = Array.from(places, (_, i) => at(i, low[i])).reverse();
  return `M${there.concat(back).join('L')}Z`;
}

function sampleOf(series) {
  const {colour, dash, mark, width = 1.8} = series;
  const line = drawn('line', {
    x1: 0,
    x2: 24,
    y1: 5,
    y2: 5,
    'stroke-width': 1.4 * width,
    'stroke-dasharray': dash || null,
    style: `stroke:${colour}`
  });
  const dot = drawn('circle', {cx: 12, cy: 5, r: 3.2, style: markStyle(series)});
  return drawn(
      'svg', {viewBox: '0 0 24 10', 'aria-hidden': 'true'}, mark === 'markers' ? null : line,
      /markers/.test(mark) ? dot : null);
}

/** Returns a legend: each name with a sample of each of its line styles. */
export function legendOf(series) {
  const names = new Map();
  for (const one of series) {
    const styles = names.get(one.name) ?? names.set(one.name, new Map()).get(one.name);
    styles.set(`${one.colour} ${one.dash}`, one);
  }
  return element(
      'ul', {class: 'legend'},
      ...Array.from(
          names, ([name, styles]) => element(
                     'li', {}, ...Array.from(styles.values(), sampleOf), element('span', {}, name))));
}

/** Returns the index of the value in an increasing list that is nearest to `value` in pixels. */
function nearest(values, value, axis) {
  let best = 0;
  const at = axis.at(value), gap = (i) => Math.abs(axis.at(values[i]) - at);
  for (let i = 1; i < values.length; ++i)
    if (gap(i) < gap(best)) best = i;
  return best;
}

/** Returns the index of a series at a position; for steps, the last one that begins before it. */
function indexAt(series, value, axis) {
  if (series.mark !== 'steps') return nearest(series.x, value, axis);
  const after = series.x.findIndex((x) => x > value);
  return after < 0 ? series.x.length - 1 : Math.max(0, after - 1);
}

/**
 * Line plot that adapts to its width. Dragging zooms the x axis; a double click resets the zoom.
 *
 * Content: {label, height, x: {title, range, log, unit, text}, y: {...}, series: [{name, x, y,
 * error, mark, colour, dash, width, band: [low, high]}], hasLegend, isCompact, isBare}.
 */
export class LinePlot {
  #spec = null;
  #index = null;
  #zoomed = null;  // visible range of the x axis
  #begin = null;   // start of a drag

  constructor() {
    this.node = element('div', {class: 'plot'});
    this.legend = element('div');
    this.root = element('div', {}, this.legend, this.node);
    this.value = new ValueBox(this.node);
    this.node.tabIndex = 0;
    this.node.setAttribute('role', 'img');
    this.node.addEventListener('keydown', (event) => this.#key(event));
    this.node.addEventListener('pointerdown', (event) => this.#grab(event));
    this.node.addEventListener('pointermove', (event) => this.#point(event));
    this.node.addEventListener('pointerup', (event) => this.#drop(event));
    this.node.addEventListener('dblclick', () => this.#zoom(null));
    for (const gone of ['pointerleave', 'blur', 'pointercancel'])
      this.node.addEventListener(gone, () => this.#leave());
    onWidth(this.node, () => this.#draw());
  }

  /** Replaces the content. */
  show(spec) {
    this.#spec = spec;
    this.node.setAttribute('aria-label', `${spec.label}. Arrow keys read values.`);
    const names = JSON.stringify(spec.series.map((one) => [one.name, one.colour, one.dash]));
    if (names !== this.names && spec.hasLegend !== false)
      this.legend.replaceChildren(legendOf(spec.series));
    this.names = names;
    drawSoon(this, () => this.#draw());
  }

  #draw() {
    const spec = this.#spec, width = widthOf(this.node);
    if (!spec || width < 20) return;
    const height = spec.height ?? 260, inner = innerOf(width, height, spec);
    const shown = this.#zoomed ? {...spec.x, range: this.#zoomed, ticks: null} : spec.x;
    this.x = axisOf(shown, inner.x, Math.max(2, Math.floor(width / 90)));
    this.y = axisOf(spec.y, inner.y, Math.max(2, Math.floor(height / 55)));
    const clip = `clip-${clips++}`;
    const inside = drawn('g', {'clip-path': `url(#${clip})`});
    for (const one of spec.series)
      if (one.band)
        inside.append(drawn(
            'path', {d: bandOf(one, this.x, this.y), style: `fill:${one.colour}`, opacity: 0.18}));
    // Dashed lines are above solid ones, which remain visible in the gaps.
    const isDashed = ({dash}) => Number(Boolean(dash));
    for (const one of [...spec.series].sort((a, b) => isDashed(a) - isDashed(b))) {
      if (one.mark !== 'markers')
        inside.append(drawn('path', {
          class: 'curve',
          d: pathOf(one, this.x, this.y),
          'stroke-width': one.width ?? 1.8,
          'stroke-dasharray': one.dash || null,
          style: `stroke:${one.colour}`
        }));
      inside.append(...marksOf(one, this.x, this.y));
    }
    this.cursor =
        drawn('line', {class: 'cursor', y1: inner.y[1], y2: inner.y[0], visibility: 'hidden'});
    this.part = drawn('rect', {
      class: 'part',
      y: inner.y[1],
      height: inner.y[0] - inner.y[1],
      width: 0,
      visibility: 'hidden'
    });
    this.svg?.remove();
    this.svg = drawn(
        'svg', {viewBox: `0 0 ${width} ${height}`, height, 'aria-hidden': 'true'},
        drawn('clipPath', {id: clip}, drawn('rect', {
                x: inner.x[0] - 4,
                y: inner.y[1] - 4,
                width: inner.x[1] - inner.x[0] + 8,
                height: inner.y[0] - inner.y[1] + 8
              })),
        frameOf(this.x, this.y, {x: spec.x.title, y: spec.y.title}, width, height, spec), inside,
        this.part, this.cursor);
    this.node.prepend(this.svg);
    this.#index = null;
    this.value.hide();
  }

  #leave() {
    this.#index = null;
    this.#begin = null;
    this.value.hide();
    for (const mark of [this.cursor, this.part]) mark?.setAttribute('visibility', 'hidden');
  }

  #pixel(event) {
    return event.clientX - this.node.getBoundingClientRect().left;
  }

  #grab(event) {
    if (event.button > 0 || !this.x) return;
    this.#begin = this.#pixel(event);
  }

  #drop(event) {
    const begin = this.#begin, end = this.#pixel(event);
    this.#leave();
    if (begin === null || Math.abs(end - begin) < 12) return;
    const range = [begin, end].sort((a, b) => a - b).map((pixel) => this.x.value(pixel));
    this.#zoom([Math.max(range[0], this.x.low), Math.min(range[1], this.x.high)]);
  }

  #zoom(range) {
    if (range && !(range[1] > range[0])) return;
    this.#zoomed = range;
    this.#draw();
  }

  #point(event) {
    if (!this.#spec?.series.length || !this.x) return;
    const pixel = this.#pixel(event);
    if (this.#begin !== null && Math.abs(pixel - this.#begin) >= 12) {
      this.part.setAttribute('x', Math.min(pixel, this.#begin));
      this.part.setAttribute('width', Math.abs(pixel - this.#begin));
      this.part.setAttribute('visibility', 'visible');
    }
    this.#read(nearest(this.#spec.series[0].x, this.x.value(pixel), this.x));
  }

  #key(event) {
    const step =
        {ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10, Home: -1e9, End: 1e9}[event.key];
    if (event.key === 'Escape') this.#zoom(null);
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
    const lines = series.slice(0, 12).map((one) => {
      const name = element('span'), n = indexAt(one, place, this.x);
      const error = one.error?.[n] > 0 ? ` \u00b1 ${shortText(one.error[n], 2)}` : '';
      name.append(
          element('i', {style: `background:${one.colour}`}),
          `${one.name}: ${text(y, one.y[n])}${error}`);
      return name;
    });
    this.cursor.setAttribute('x1', at);
    this.cursor.setAttribute('x2', at);
    this.cursor.setAttribute('visibility', 'visible');
    this.said = [text(x, place), ...lines.map((line) => line.textContent)].join(', ');
    this.value.show(at, this.node.clientHeight / 3, text(x, place), ...lines);
  }
}
