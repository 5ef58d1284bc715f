// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Export of figures as SVG and PNG, and of data as CSV.

import {drawn, element} from './dom.js';

const quoted = (value) => {
  const text = value === null || value === undefined || Number.isNaN(value) ? '' : String(value);
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};

/** Converts rows to comma-separated values. */
export const csvOf = (rows) => rows.map((row) => row.map(quoted).join(',') + '\n').join('');

const styles = [
  'fill', 'stroke', 'stroke-width', 'stroke-dasharray', 'stroke-linejoin', 'opacity', 'font-size',
  'font-family', 'font-weight', 'visibility'
];

/** Returns a copy of an SVG element with inline styles. */
function inked(svg) {
  const copy = svg.cloneNode(true);
  const from = [svg, ...svg.querySelectorAll('*')], to = [copy, ...copy.querySelectorAll('*')];
  from.forEach((node, i) => {
    const style = getComputedStyle(node);
    to[i].removeAttribute('class');
    to[i].setAttribute(
        'style', styles.map((name) => `${name}:${style.getPropertyValue(name)}`).join(';'));
  });
  return copy;
}

/** Returns the lines of a text node, which break after spaces and hyphens: [{text, box}]. */
function linesOf(node) {
  const content = node.textContent, range = document.createRange(), lines = [];
  for (const {index, 0: part} of content.matchAll(/[^\s-]*-|[^\s-]+/g)) {
    const end = index + part.length, last = lines.at(-1);
    range.setStart(node, index);
    range.setEnd(node, end);
    const box = range.getBoundingClientRect();
    if (last && Math.abs(last.box.top - box.top) < 2)
      last.end = end;
    else
      lines.push({start: index, end, box});
  }
  return lines.map(({start, end, box}) => ({text: content.slice(start, end).replace(/\s+/g, ' '), box}));
}

/** Returns the lines of text in an element: [{text, box, owner}]. */
function textsOf(root) {
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT), texts = [];
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const owner = node.parentElement;
    if (owner.closest('svg, .save, .value, .choice, [hidden]')) continue;
    for (const line of linesOf(node)) texts.push({...line, owner});
  }
  return texts;
}

/** Returns a figure in its current state as the text of an SVG file. */
export function svgOf(root) {
  const frame = root.getBoundingClientRect();
  const placed = (box) => ({x: box.left - frame.left, y: box.top - frame.top});
  const page = drawn('svg', {
    xmlns: 'http://www.w3.org/2000/svg',
    viewBox: `0 0 ${frame.width} ${frame.height}`,
    width: frame.width,
    height: frame.height
  });
  page.append(drawn('rect', {
    width: frame.width,
    height: frame.height,
    fill: getComputedStyle(document.body).backgroundColor
  }));
  for (const canvas of root.querySelectorAll('canvas')) {
    const box = canvas.getBoundingClientRect();
    page.append(drawn('image', {
      ...placed(box),
      width: box.width,
      height: box.height,
      preserveAspectRatio: 'none',
      style: 'image-rendering:pixelated',
      href: canvas.toDataURL()
    }));
  }
  for (const svg of root.querySelectorAll('svg')) {
    const box = svg.getBoundingClientRect(), copy = inked(svg);
    const {x, y} = placed(box);
    for (const [name, value] of Object.entries({x, y, width: box.width, height: box.height}))
      copy.setAttribute(name, value);
    page.append(copy);
  }
  for (const {text, box, owner} of textsOf(root)) {
    const style = getComputedStyle(owner);
    const size = parseFloat(style.fontSize), {x, y} = placed(box);
    page.append(drawn('text', {
      x,
      y: y + 0.5 * box.height + 0.35 * size,
      fill: style.color,
      'font-size': size,
      'font-family': style.fontFamily,
      'font-weight': style.fontWeight
    }, text));
  }
  return new XMLSerializer().serializeToString(page);
}

/** Returns a figure in its current state as a PNG image at twice the resolution. */
export async function pngOf(root) {
  const {width, height} = root.getBoundingClientRect(), picture = new Image();
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgOf(root))}`;
  await picture.decode();
  const canvas = element('canvas', {width: 2 * Math.round(width), height: 2 * Math.round(height)});
  canvas.getContext('2d').drawImage(picture, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => { canvas.toBlob(resolve, 'image/png'); });
}
