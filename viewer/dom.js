// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Elements of the page, and what is said to those who do not see them.

const svgNamespace = 'http://www.w3.org/2000/svg';

/** The element of the page with this id. */
export const byId = (id) => document.getElementById(id);

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on'))
      node.addEventListener(name.slice(2), value);
    else
      node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.filter((child) => child !== null && child !== undefined));
  return node;
}

/** An HTML element with attributes (`onclick` and such are listeners) and children. */
export const element = (name, attributes = {}, ...children) =>
    filled(document.createElement(name), attributes, children);

/** The same of SVG. */
export const drawn = (name, attributes = {}, ...children) =>
    filled(document.createElementNS(svgNamespace, name), attributes, children);

/** Says a sentence to screen readers. */
export function announce(text) {
  const status = byId('status');
  status.textContent = status.textContent === text ? text + '\u00a0' : text;
}

/** Shows a message above everything until it is put away; an empty one hides it. */
export function notice(text) {
  const place = byId('notice');
  place.hidden = !text;
  place.replaceChildren(...(
      text ?
          [
            element('span', {}, text),
            element(
                'button',
                {type: 'button', 'aria-label': 'Put the message away', onclick: () => notice('')},
                'OK')
          ] :
          []));
}

/** Shows a problem where it arose, or takes it away. */
export function showProblem(place, text) {
  place.hidden = !text;
  if (place.textContent !== (text ?? '')) place.textContent = text ?? '';
}

const widths = new WeakMap();

/** Calls `redraw()` when the element's width changes, once at first. */
export function onWidth(node, redraw) {
  new ResizeObserver(([entry]) => {
    const width = Math.floor(entry.contentRect.width);
    if (width === widthOf(node)) return;
    widths.set(node, width);
    if (width > 0) drawSoon(node, redraw);  // later: it changes heights, which are observed, too
  }).observe(node);
}

/** The width of such an element in pixels, without the layout that asking the browser costs. */
export const widthOf = (node) => widths.get(node) ?? 0;

const drawings = new Map();

/** Draws before the next frame, once however often it is asked for. */
export function drawSoon(owner, draw) {
  if (!drawings.size)
    requestAnimationFrame(() => {
      const now = [...drawings.values()];
      drawings.clear();
      for (const one of now) one();
    });
  drawings.set(owner, draw);
}

const probe = element('span', {hidden: true}), colours = new Map();

/** What a colour of the style sheets is at present, for canvases. */
export function colourOf(name) {
  if (!probe.isConnected) document.body.append(probe);
  if (!colours.has(name)) {
    probe.style.color = `var(${name})`;
    colours.set(name, getComputedStyle(probe).color);
  }
  return colours.get(name);
}

/** Colours are others from now on. */
export const forgetColours = () => colours.clear();

/** Lets a person save a text as a file. */
export const saveText = (text, name, type) => saveBlob(new Blob([text], {type}), name);

/** The same of bytes. */
export function saveBlob(blob, name) {
  const address = URL.createObjectURL(blob);
  element('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** Copies a text; gives whether that was allowed. */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = element('textarea', {style: 'position:fixed;opacity:0'});
    area.value = text;
    document.body.append(area);
    area.select();
    const copied = document.execCommand('copy');
    area.remove();
    return copied;
  }
}
