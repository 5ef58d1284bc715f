// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Elements of the page, and announcements to screen readers.

const svgNamespace = 'http://www.w3.org/2000/svg';

/** Returns the element with this id. */
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

/** Creates an HTML element. Attributes such as `onclick` add listeners. */
export const element = (name, attributes = {}, ...children) =>
    filled(document.createElement(name), attributes, children);

/** Creates an SVG element. */
export const drawn = (name, attributes = {}, ...children) =>
    filled(document.createElementNS(svgNamespace, name), attributes, children);

/** Announces a text to screen readers. */
export function announce(text) {
  const status = byId('status');
  status.textContent = status.textContent === text ? text + '\u00a0' : text;
}

/** Shows a message above the page until it is dismissed; an empty text hides it. */
export function notice(text) {
  const place = byId('notice');
  place.hidden = !text;
  place.replaceChildren(...(
      text ?
          [
            element('span', {}, text),
            element(
                'button',
                {type: 'button', 'aria-label': 'Dismiss this message', onclick: () => notice('')},
                'OK')
          ] :
          []));
}

/** Shows an error message in an element and marks the input as invalid; an empty text hides it. */
export function showProblem(place, text, input = null) {
  place.hidden = !text;
  if (place.textContent !== (text ?? '')) place.textContent = text ?? '';
  input?.toggleAttribute('aria-invalid', false);
  if (text) input?.setAttribute('aria-invalid', 'true');
}

const widths = new WeakMap();

/** Calls `redraw()` initially and whenever the element's width changes. */
export function onWidth(node, redraw) {
  new ResizeObserver(([entry]) => {
    const width = Math.floor(entry.contentRect.width);
    if (width === widthOf(node)) return;
    widths.set(node, width);
    if (width > 0) drawSoon(node, redraw);  // deferred, because it changes observed heights
  }).observe(node);
}

/** Returns the last observed width of such an element in pixels, without forcing a layout. */
export const widthOf = (node) => widths.get(node) ?? 0;

const drawings = new Map();

/** Draws before the next frame; repeated requests of an owner draw once. */
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

/** Returns the current value of a colour variable, for canvases. */
export function colourOf(name) {
  if (!probe.isConnected) document.body.append(probe);
  if (!colours.has(name)) {
    probe.style.color = `var(${name})`;
    colours.set(name, getComputedStyle(probe).color);
  }
  return colours.get(name);
}

/** Clears the cached colours after a change of the theme. */
export const forgetColours = () => colours.clear();

/** Downloads a text as a file. */
export const saveText = (text, name, type) => saveBlob(new Blob([text], {type}), name);

/** Downloads a blob as a file. */
export function saveBlob(blob, name) {
  const address = URL.createObjectURL(blob);
  element('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** Copies a text to the clipboard. Returns false if the browser does not allow it. */
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
