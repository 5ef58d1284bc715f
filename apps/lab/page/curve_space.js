// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A curve in space on a canvas, turned by pointer and keys; all of them turn together.

import {cssColour, sequentialColour} from './colours.js';
import {colourOf, drawSoon, element, forgetColours, onWidth, widthOf} from './dom.js';

const view = {
  yaw: 0.6,
  pitch: 0.45,
  zoom: 1
};
const shown = new Set();

function turn(yaw, pitch) {
  view.yaw += yaw;
  view.pitch = Math.max(-1.55, Math.min(1.55, view.pitch + pitch));
  for (const space of shown) drawSoon(space, () => space.draw());
}

function projection(width, height, radius) {
  const [sy, cy, sp, cp] =
      [Math.sin(view.yaw), Math.cos(view.yaw), Math.sin(view.pitch), Math.cos(view.pitch)];
  const scale = 0.46 * Math.min(width, height) / radius * view.zoom;
  return (x, y, z) => {
    const across = cy * x - sy * y, away = sy * x + cy * y;
    return [
      width / 2 + scale * across, height / 2 - scale * (cp * z + sp * away), cp * away - sp * z
    ];
  };
}

function redrawAll() {
  forgetColours();
  for (const space of shown) space.draw();
}
addEventListener('themechange', redrawAll);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redrawAll);

/**
 * One coding curve. What it shows: {label, points: (N, 3) as one array, radius of all, range_m}.
 */
export class CurveSpace {
  #spec = null;

  constructor() {
    this.canvas = element('canvas', {class: 'turned', tabindex: 0, role: 'img'});
    this.node = element('div', {class: 'plot'}, this.canvas);
    this.root = this.node;
    this.canvas.addEventListener('keydown', (event) => this.#key(event));
    this.canvas.addEventListener('pointerdown', (event) => this.#grab(event));
    this.canvas.addEventListener('pointermove', (event) => this.#drag(event));
    onWidth(this.node, () => this.draw());
  }

  /** Shows something else; null: no longer shown. */
  show(spec) {
    this.#spec = spec;
    if (!spec) return void shown.delete(this);
    shown.add(this);
    this.canvas.setAttribute(
        'aria-label',
        `${spec.label}. Arrow keys turn it, plus and minus change its size, 0 turns it back.`);
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
    if (zoom) view.zoom = Math.min(8, Math.max(0.3, view.zoom * zoom));
    if (event.key === '0') Object.assign(view, {yaw: 0.6, pitch: 0.45, zoom: 1});
    turn(...(step ?? [0, 0]));
  }

  #grab(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.last = [event.clientX, event.clientY];
  }

  #drag(event) {
    if (!this.canvas.hasPointerCapture(event.pointerId)) return;
    turn((event.clientX - this.last[0]) * 0.01, (event.clientY - this.last[1]) * 0.01);
    this.last = [event.clientX, event.clientY];
  }

  /** Draws it as it stands. */
  draw() {
    const width = widthOf(this.node), spec = this.#spec;
    if (!spec || width < 20) return;
    const height = Math.min(width, 320), ratio = window.devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(width * ratio) ||
        this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio);
      this.canvas.height = Math.round(height * ratio);
      this.canvas.style.height = `${height}px`;
    }
    const context = this.canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const project = projection(width, height, spec.radius);
    drawAxes(context, project, spec.radius * 0.75);
    drawCurve(context, project, spec.points);
  }
}

function drawAxes(context, project, length) {
  context.strokeStyle = colourOf('--rule');
  context.fillStyle = colourOf('--muted');
  context.font = '11px system-ui, sans-serif';
  context.lineWidth = 1;
  [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((axis, i) => {
    const end = axis.map((v) => v * length), start = end.map((v) => -v);
    const [x0, y0] = project(...start), [x1, y1] = project(...end);
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
    context.fillText(`axis ${i + 1}`, x1 + 4, y1 + 3);
  });
}

function drawCurve(context, project, points) {
  const count = points.length / 3;
  const ends = Array.from(
      {length: count}, (_, i) => project(points[3 * i], points[3 * i + 1], points[3 * i + 2]));
  const pieces = ends.map((end, i) => ({i, from: end, to: ends[(i + 1) % count]}))
                     .sort((a, b) => b.from[2] - a.from[2]);
  const depths = ends.map((end) => end[2]);
  const [near, far] = [Math.min(...depths), Math.max(...depths)];
  context.lineCap = 'round';
  for (const {i, from, to} of pieces) {
    context.strokeStyle = cssColour(sequentialColour(i / count));
    context.lineWidth = 2 + 2.5 * (far > near ? (far - from[2]) / (far - near) : 0);
    context.beginPath();
    context.moveTo(from[0], from[1]);
    context.lineTo(to[0], to[1]);
    context.stroke();
  }
}
