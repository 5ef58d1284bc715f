// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Curves and points in three dimensions on a canvas, which the pointer and keys rotate.

import {colourOf, drawSoon, element, forgetColours, onWidth, widthOf} from './dom.js';

const start = {
  yaw: 0.6,
  pitch: 0.45,
  zoom: 1
};
const views = new Set();

/** Viewing direction shared by several drawings, which rotate together. */
export class SpaceView {
  constructor(direction = {}) {
    this.start = {...start, ...direction};
    this.spaces = new Set();
    views.add(this);
    this.reset();
  }

  reset() {
    Object.assign(this, this.start);
    this.redraw();
  }

  turn(yaw, pitch, zoom = 1) {
    this.yaw += yaw;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + pitch));
    this.zoom = Math.min(8, Math.max(0.3, this.zoom * zoom));
    this.redraw();
  }

  redraw() {
    for (const space of this.spaces) drawSoon(space, () => space.draw());
  }

  /**
   * Returns a function that projects a point to pixels and its distance. Points are in a sphere of
   * this radius or, if given, in a box of these half lengths, which fits in the initial direction.
   */
  projection(width, height, {radius, box}) {
    const [sy, cy, sp, cp] =
        [Math.sin(this.yaw), Math.cos(this.yaw), Math.sin(this.pitch), Math.cos(this.pitch)];
    const [wide, high] = box ? shadowOf(box, this.start) : [radius, radius / 1.3];
    const scale = 0.46 * Math.min(width / wide, height / high) * this.zoom;
    return (x, y, z) => {
      const across = cy * x - sy * y, away = sy * x + cy * y;
      return [
        width / 2 + scale * across, height / 2 - scale * (cp * z + sp * away), cp * away - sp * z
      ];
    };
  }
}

/** Returns half the width and height of a box in a viewing direction. */
function shadowOf([x, y, z], {yaw, pitch}) {
  const sy = Math.abs(Math.sin(yaw)), cy = Math.abs(Math.cos(yaw));
  const away = sy * x + cy * y;
  return [cy * x + sy * y, Math.cos(pitch) * z + Math.abs(Math.sin(pitch)) * away];
}

function redrawAll() {
  forgetColours();
  for (const view of views) view.redraw();
}
addEventListener('themechange', redrawAll);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redrawAll);

/**
 * Three-dimensional drawing. Content: {label, view, points: (N, 3) as one array around the origin,
 * colour(i): CSS colour of a point, isCurve: closed curve or points, pointSize, radius or box of
 * all points (see projection), axes: [{title, from, to}], height}.
 */
export class Space {
  #spec = null;

  constructor() {
    this.canvas = element('canvas', {class: 'turned', tabindex: 0, role: 'img'});
    this.node = element('div', {class: 'plot'}, this.canvas);
    this.root = this.node;
    this.canvas.addEventListener('keydown', (event) => this.#key(event));
    this.canvas.addEventListener('pointerdown', (event) => this.#grab(event));
    this.canvas.addEventListener('pointermove', (event) => this.#drag(event));
    this.canvas.addEventListener('wheel', (event) => this.#wheel(event), {passive: false});
    this.canvas.addEventListener('dblclick', () => this.#spec?.view.reset());
    onWidth(this.node, () => this.draw());
  }

  /** Replaces the content; null: removes the drawing from its view. */
  show(spec) {
    this.#spec?.view.spaces.delete(this);
    this.#spec = spec;
    if (!spec) return;
    spec.view.spaces.add(this);
    this.canvas.setAttribute(
        'aria-label',
        `${spec.label}. Arrow keys rotate it, plus and minus zoom, 0 resets the view.`);
    drawSoon(this, () => this.draw());
  }

  #key(event) {
    const step = {
      ArrowLeft: [-0.1, 0],
      ArrowRight: [0.1, 0],
      ArrowUp: [0, -0.1],
      ArrowDown: [0, 0.1]
    }[event.key];
    const zoom = {'+': 1.15, '=': 1.15, '-': 1 / 1.15}[event.key];
    if (event.ctrlKey || event.metaKey || (!step && !zoom && event.key !== '0')) return;
    event.preventDefault();
    if (event.key === '0') return void this.#spec.view.reset();
    this.#spec.view.turn(...(step ?? [0, 0]), zoom);
  }

  // The wheel scrolls the page unless Ctrl is pressed, as in maps.
  #wheel(event) {
    if (!event.ctrlKey) return;
    event.preventDefault();
    this.#spec?.view.turn(0, 0, event.deltaY < 0 ? 1.1 : 1 / 1.1);
  }

  #grab(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.last = [event.clientX, event.clientY];
  }

  #drag(event) {
    if (!this.canvas.hasPointerCapture(event.pointerId)) return;
    this.#spec.view.turn(
        (event.clientX - this.last[0]) * 0.01, (event.clientY - this.last[1]) * 0.01);
    this.last = [event.clientX, event.clientY];
  }

  /** Draws the content in the current viewing direction. */
  draw() {
    const width = widthOf(this.node), spec = this.#spec;
    if (!spec || width < 20) return;
    const height = Math.min(width, spec.height ?? 320), ratio = window.devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(width * ratio) ||
        this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.canvas.style.height = `${height}px`;
    }
    const context = this.canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const project = spec.view.projection(width, height, spec);
    drawAxes(context, project, spec.axes, width);
    (spec.isCurve ? drawCurve : drawPoints)(context, project, spec);
  }
}

function drawAxes(context, project, axes, width) {
  context.strokeStyle = colourOf('--rule');
  context.fillStyle = colourOf('--muted');
  context.font = '11px system-ui, sans-serif';
  context.lineWidth = 1;
  for (const {title, from, to} of axes) {
    const [x0, y0] = project(...from), [x1, y1] = project(...to);
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
    const wide = context.measureText(title).width;
    context.fillText(title, Math.max(2, Math.min(x1 + 4, width - wide - 2)), y1 + 3);
  }
}

const placesOf = ({points}, project) => Array.from(
    {length: points.length / 3},
    (_, i) => project(points[3 * i], points[3 * i + 1], points[3 * i + 2]));

function drawCurve(context, project, spec) {
  const ends = placesOf(spec, project), count = ends.length;
  const pieces = ends.map((end, i) => ({i, from: end, to: ends[(i + 1) % count]}))
                     .sort((a, b) => b.from[2] - a.from[2]);
  const depths = ends.map((end) => end[2]);
  const [near, far] = [Math.min(...depths), Math.max(...depths)];
  context.lineCap = 'round';
  for (const {i, from, to} of pieces) {
    context.strokeStyle = spec.colour(i);
    context.lineWidth = 2 + 2.5 * (far > near ? (far - from[2]) / (far - near) : 0);
    context.beginPath();
    context.moveTo(from[0], from[1]);
    context.lineTo(to[0], to[1]);
    context.stroke();
  }
}

function drawPoints(context, project, spec) {
  const places = placesOf(spec, project), size = spec.pointSize ?? 2;
  const order = places.map((_, i) => i).sort((a, b) => places[b][2] - places[a][2]);
  for (const i of order) {
    context.fillStyle = spec.colour(i);
    context.fillRect(places[i][0] - size / 2, places[i][1] - size / 2, size, size);
  }
}
