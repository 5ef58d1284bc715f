// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Light and gate of every measurement over one period; edges of binary waveforms can be moved.

import {announce, drawn, drawSoon, element, onWidth, widthOf} from '../../../viewer/dom.js';
import {rangeOf, thinned} from '../../../viewer/numbers.js';

const left = 30, right = 10, axis = 22;
const reach = matchMedia('(pointer: coarse)').matches ? 15 : 9;  // pixels on either side of an edge
const periods = [0, 0.25, 0.5, 0.75, 1];

/**
 * Intervals in which a binary waveform is on: converts [rise0, fall0, ...] to [from, to] in [0, 1].
 */
export function onParts(edges) {
  const parts = [];
  for (let e = 0; e + 1 < edges.length; e += 2) {
    const [rise, fall] = [edges[e], edges[e + 1]];
    if (fall > rise)
      parts.push([rise, fall]);
    else
      parts.push([rise, 1], [0, fall]);
  }
  return parts.filter(([from, to]) => to > from).sort((a, b) => a[0] - b[0]);
}

function stepsOf(edges, x, base, top) {
  let path = `M${x(0)},${base}`;
  for (const [from, to] of onParts(edges))
    path += (from > 0 ? `H${x(from).toFixed(1)}` : '') + `V${top}H${x(to).toFixed(1)}` +
        (to < 1 ? `V${base}` : '');
  return path.endsWith(`V${base}`) || path.startsWith('M') && !path.includes('V') ?
      `${path}H${x(1)}` :
      path;
}

function lineOf(all, x, y) {
  const values = thinned(all, 2048);
  const at = (place, value) => `${x(place).toFixed(1)},${y(value).toFixed(1)}`,
        count = values.length;
  const edge = (values[0] + values[count - 1]) / 2;
  const points = Array.from(values, (value, n) => at((n + 0.5) / count, value));
  return 'M' + [at(0, edge), ...points, at(1, edge)].join('L');
}

const areaOf = (values, x, base, y) => `${lineOf(values, x, y)}V${base}H${x(0)}Z`;

/** Height of one waveform; smaller if there are many. */
const laneHeight = (count) => Math.max(20, Math.min(36, Math.round(330 / (2 * count))));

/**
 * Plot of the waveforms of one code. Content: {label, samples, light, gates: {values, shape},
 * lightBehind, gatesBehind (after the impulse responses), lightEdges, gateEdges, move(arm,
 * measurement, edge, position), settle()}.
 */
export class WaveformPlot {
  #spec = null;
  #held = null;     // the edge under the pointer
  #current = null;  // edge that the keys move, and its position
  #chosen = 0;

  constructor() {
    this.node = element('div', {class: 'plot', role: 'group'});
    this.root = this.node;
    this.node.addEventListener('pointerdown', (event) => this.#grab(event));
    this.node.addEventListener('pointermove', (event) => this.#drag(event));
    for (const end of ['pointerup', 'pointercancel'])
      this.node.addEventListener(end, () => this.#drop());
    this.node.addEventListener('keydown', (event) => this.#key(event));
    onWidth(this.node, () => this.#draw());
  }

  /** Replaces the content. */
  show(spec) {
    this.#spec = spec;
    this.node.setAttribute('aria-label', spec.label);
    drawSoon(this, () => this.#draw());
  }

  #draw() {
    const spec = this.#spec, width = widthOf(this.node);
    if (!spec || width < 20) return;
    const count = spec.light.shape[0], lane = laneHeight(count), gap = 8;
    const height = count * (2 * lane + gap) + axis,
          x = (place) => left + place * (width - left - right);
    this.scale = {x, span: width - left - right};
    const picture = drawn('svg', {viewBox: `0 0 ${width} ${height}`, height});
    for (const place of width < 360 ? [0, 0.5, 1] : periods) {
      picture.append(
          drawn('line', {class: 'grid', x1: x(place), x2: x(place), y1: 0, y2: height - axis}),
          drawn(
              'text', {
                class: 'tick',
                x: x(place),
                y: height - 6,
                'text-anchor': place === 1 ? 'end' : 'middle'
              },
              place === 1 ? '1 period' : String(place)));
    }
    const handles = drawn('g', {});
    for (let k = 0; k < count; ++k) {
      const top = k * (2 * lane + gap);
      picture.append(drawn(
          'text', {class: 'tick', x: left - 8, y: top + lane + 6, 'text-anchor': 'end'},
          String(k + 1)));
      this.#lane(picture, handles, 'light', k, top + lane, lane - 4);
      this.#lane(picture, handles, 'gate', k, top + 2 * lane, lane - 4);
    }
    picture.append(handles);
    const hadFocus = this.node.contains(document.activeElement);
    this.svg?.remove();
    this.svg = picture;
    this.node.append(picture);
    this.edges = [...handles.children];
    this.#rove(hadFocus);
  }

  #lane(picture, handles, arm, k, base, room) {
    const {light, gates, lightBehind, gatesBehind, lightEdges, gateEdges} = this.#spec;
    const [plane, behind] = arm === 'light' ? [light, lightBehind] : [gates, gatesBehind],
                  samples = plane.shape[1];
    const edges = (arm === 'light' ? lightEdges : gateEdges)?.[k] ?? [];
    const rowOf = ({values: all}) => all.subarray(k * samples, (k + 1) * samples);
    const values = rowOf(plane), seen = rowOf(behind ?? plane);
    const on = onParts(edges).reduce((sum, [from, to]) => sum + to - from, 0);
    const mean = values.reduce((sum, value) => sum + value, 0) / samples;
    const level = on > 0 ? mean / on : 0;
    const top = Math.max(level, arm === 'gate' ? 1 : 0, rangeOf([values, seen])[1]) || 1;
    const colour = `var(--s${arm === 'light' ? 0 : 1})`, y = (value) => base - room * value / top,
          {x} = this.scale;
    picture.append(
        drawn('line', {class: 'lane-base', x1: x(0), x2: x(1), y1: base, y2: base}), drawn('path', {
          d: areaOf(seen, x, base, y),
          style: `fill:${colour}`,
          opacity: edges.length ? 0.22 : 0.3
        }),
        drawn('path', {
          class: 'curve',
          d: edges.length ? stepsOf(edges, x, base, y(level)) : lineOf(values, x, y),
          'stroke-width': 1.5,
          style: `stroke:${colour}`
        }));
    edges.forEach((place, edge) => {
      const word = arm === 'light' ? 'Light' : 'Gate', turn = edge % 2 ? 'falls' : 'rises';
      const what = `${word} of measurement ${k + 1} ${turn}`;
      handles.append(drawn(
          'g', {
            class: `edge${this.#isHeld(arm, k, edge) ? ' held' : ''}`,
            tabindex: -1,
            role: 'slider',
            'aria-label': what,
            'aria-valuemin': 0,
            'aria-valuemax': 1,
            'aria-valuenow': place.toFixed(4),
            'aria-valuetext': `at ${place.toFixed(4)} of the period`,
            'data-arm': arm,
            'data-k': k,
            'data-edge': edge,
            'data-place': place,
            style: `color:${colour};stroke:${colour}`
          },
          drawn('title', {}, `${what} at ${place.toFixed(4)} of the period`), drawn('rect', {
            class: 'reach',
            stroke: 'none',
            x: x(place) - reach,
            y: base - room - 2,
            width: 2 * reach,
            height: room + 4
          }),
          drawn('circle', {class: 'grip', cx: x(place), cy: base - room / 2, r: 3.6})));
    });
  }

  #isHeld(arm, k, edge) {
    return this.#held?.arm === arm && this.#held.k === k && this.#held.edge === edge;
  }

  // Tab focuses one edge, keys move to the others; a moved edge keeps the focus.
  #rove(hadFocus) {
    if (!this.edges.length) return;
    if (this.#current) {
      const distance = (edge) => {
        const gap = Math.abs(Number(edge.dataset.place) - this.#current.place) % 1;
        return edge.dataset.arm === this.#current.arm &&
                Number(edge.dataset.k) === this.#current.k &&
                Number(edge.dataset.edge) % 2 === this.#current.edge % 2 ?
            Math.min(gap, 1 - gap) :
            9;
      };
      const nearest =
          this.edges.reduce((best, edge) => (distance(edge) < distance(best) ? edge : best));
      this.#chosen = this.edges.indexOf(nearest);
    }
    this.#chosen = Math.min(this.#chosen, this.edges.length - 1);
    this.edges[this.#chosen].setAttribute('tabindex', 0);
    if (hadFocus) this.edges[this.#chosen].focus({preventScroll: true});
  }

  #grab(event) {
    const edge = event.target.closest?.('.edge');
    if (!edge || event.button > 0) return;
    event.preventDefault();
    const {arm, k, edge: index} = edge.dataset;
    this.#held = {arm, k: Number(k), edge: Number(index)};
    this.#current = null;
    this.offset = Number(edge.dataset.place) - this.#placeOf(event);
    this.node.setPointerCapture(event.pointerId);
    edge.classList.add('held');
  }

  #placeOf(event) {
    return (event.clientX - this.node.getBoundingClientRect().left - left) / this.scale.span;
  }

  #drag(event) {
    if (!this.#held) return;
    const {arm, k, edge} = this.#held;
    this.#spec.move(arm, k, edge, this.#placeOf(event) + this.offset);
  }

  #drop() {
    if (!this.#held) return;
    this.#held = null;
    this.#spec.settle();
    this.#draw();
  }

  #key(event) {
    const edge = event.target.closest?.('.edge');
    if (!edge || event.ctrlKey || event.metaKey || event.altKey) return;
    const other = {ArrowUp: -1, ArrowDown: 1}[event.key],
          step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (other === undefined && step === undefined) return;
    event.preventDefault();
    if (other !== undefined) {
      this.edges[this.#chosen].setAttribute('tabindex', -1);
      this.#current = null;
      this.#chosen = (this.edges.indexOf(edge) + other + this.edges.length) % this.edges.length;
      this.edges[this.#chosen].setAttribute('tabindex', 0);
      this.edges[this.#chosen].focus();
      return;
    }
    const {arm, k, edge: index, place} = edge.dataset;
    const next = Number(place) + step * (event.shiftKey ? 10 : 1) / this.#spec.samples;
    this.#current = {arm, k: Number(k), edge: Number(index), place: ((next % 1) + 1) % 1};
    this.#spec.move(arm, Number(k), Number(index), next);
    this.#spec.settle();
    announce(
        `${edge.getAttribute('aria-label')} at ${this.#current.place.toFixed(4)} of the period`);
  }
}
