// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Mapping of values to colours, and the colour bar.

import {colourMaps, cssColour} from './colours.js';
import {element} from './dom.js';
import {shortText} from './numbers.js';

/** Returns a colour bar. Content: {title, low, high: texts of the ends, colour(place)}. */
export function colourBar({title, low, high, colour}) {
  const strip = element('canvas', {
    width: 128,
    height: 1,
    role: 'img',
    'aria-label': `Colours of ${title}, from ${low} to ${high}`
  });
  const context = strip.getContext('2d');
  for (let i = 0; i < strip.width; ++i) {
    context.fillStyle = cssColour(colour(i / (strip.width - 1)));
    context.fillRect(i, 0, 1, 1);
  }
  return element(
      'div', {class: 'scale'}, element('span', {}, title),
      element('div', {}, element('span', {}, low), strip, element('span', {}, high)));
}

const shades = 512;  // size of the lookup table

/** Returns the quantile of sorted values. */
const quantile = (sorted, share) => sorted[Math.round(share * (sorted.length - 1))];

/** Returns the range of a document's colour scale for these arrays of values. */
function fittedRange({range, map, log, clip}, arrays) {
  if (range) return range;
  const isSigned = map === 'diverging';
  const shown = Float64Array.from(arrays.flatMap((array) => Array.from(array)))
                    .filter((value) => Number.isFinite(value) && !(log && value <= 0))
                    .map((value) => (isSigned ? Math.abs(value) : value))
                    .sort();
  if (!shown.length) return isSigned ? [-1, 1] : [0.1, 1];
  const high = quantile(shown, 1 - clip), low = isSigned ? -high : quantile(shown, clip);
  if (high > low) return [low, high];
  const half = low === 0 ? 1 : Math.abs(low) / 2;
  return [low - half, high + half];
}

/**
 * Converts a colour scale of a document, {label, unit, map, log, range, clip}, for these values.
 * Returns {colour(value): [r, g, b] or null, text(value), bar: content of colourBar()}.
 */
export function scaleOf(scale, arrays) {
  const [low, high] = fittedRange(scale, arrays), colour = colourMaps[scale.map];
  const table = Array.from({length: shades}, (_, i) => colour(i / (shades - 1)));
  const shadeAt = (share) => table[Math.round(Math.min(1, Math.max(0, share)) * (shades - 1))];
  const place = scale.log ? (v) => Math.log(v / low) / Math.log(high / low) :
                            (v) => (v - low) / (high - low);
  const unit = scale.unit ? ` ${scale.unit}` : '';
  return {
    colour: (v) => (Number.isFinite(v) && !(scale.log && v <= 0) ? shadeAt(place(v)) : null),
    text: (v) => `${shortText(v, 4)}${unit}`,
    bar: {
      title: scale.unit ? `${scale.label} (${scale.unit})` : scale.label,
      low: shortText(low, 3),
      high: shortText(high, 3),
      colour
    }
  };
}
