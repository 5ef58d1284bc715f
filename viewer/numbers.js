// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Number formats and axis ticks.

const superscripts = '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079';

/** Returns 10 to an integer power as text. */
export const powerText = (power) =>
    '10' + Array.from(String(power), (c) => superscripts[c] ?? '\u207b').join('');

/** Formats a number with at most this many significant digits, without trailing zeros. */
export function shortText(value, digits = 4) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? 'none' : String(value);
  const text = String(Number(value.toPrecision(digits)));
  return text.replace('e+', 'e');
}

/**
 * Formats a number for tables, with exactly this many significant digits; without an exponent below
 * 1e6.
 */
export function fixedText(value, digits) {
  if (!Number.isFinite(value)) return 'none';
  if (value === 0) return '0';
  const power = Math.floor(Math.log10(Math.abs(Number(value.toPrecision(digits)))));
  return power >= 6 || power < -5 ? value.toExponential(digits - 1) :
                                    value.toFixed(Math.max(0, digits - 1 - power));
}

/**
 * Formats a number for input fields: all digits, with an exponent in steps of three for large and
 * small numbers.
 */
export function fieldText(value) {
  if (value === null || value === undefined) return '';
  if (Array.isArray(value)) return `[${value.map(fieldText).join(', ')}]`;
  if (typeof value !== 'number') return String(value);
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-3 && size < 1e5) || !Number.isFinite(value)) return String(value);
  const power = 3 * Math.floor(Math.log10(size) / 3 + 1e-9);
  return `${Number((value / 10 ** power).toPrecision(15))}e${power}`;
}

/** Formats a length, given in metres, in millimetres or metres. */
export const lengthText = (metres, digits = 4) => Math.abs(metres) < 1 ?
    `${shortText(metres * 1e3, digits)} mm` :
    `${shortText(metres, digits)} m`;

/** Formats an electron rate for axes and lists. */
export function rateText(value) {
  if (!(value > 0)) return shortText(value);
  const power = Math.floor(Math.log10(value) + 1e-6), front = shortText(value / 10 ** power, 2);
  return front === '1' ? powerText(power) : `${front}\u00b7${powerText(power)}`;
}

/** Returns about `count` round values within [low, high]. */
export function linearTicks(low, high, count) {
  const rough = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((s) => s * power >= rough * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
    ticks.push(i * step);
  const decimals = Math.min(12, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  return ticks.map(
      (value) =>
          ({value, text: Math.abs(value) >= 1e6 ? shortText(value) : value.toFixed(decimals)}));
}

/** Returns powers of ten within [low, high]; if there are few, also 2 and 5 times these. */
export function logarithmicTicks(low, high) {
  if (high / low < 4) return linearTicks(low, high, 4);  // too few steps of 1, 2, 5
  const ticks = [];
  const isPlain = low >= 1e-3 && high <= 1e5;
  const few = Math.log10(high / low) < 2.2;
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
    for (const factor of few ? [1, 2, 5] : [1]) {
      const value = factor * 10 ** power;
      if (value < low * 0.9999 || value > high * 1.0001) continue;
      ticks.push({value, text: isPlain ? shortText(value) : factor === 1 ? powerText(power) : ''});
    }
  const step = Math.ceil(ticks.length / 9);
  return few ? ticks : ticks.filter((_, i) => i % step === 0);
}

/** Returns every n-th value, with the smallest n that leaves at most `most` values. */
export function thinned(values, most) {
  const step = Math.ceil(values.length / most);
  return step < 2 ? values : values.filter((_, i) => i % step === 0);
}

/** Returns the minimum and the maximum finite value. */
export function rangeOf(arrays, positive = false) {
  let low = Infinity, high = -Infinity;
  for (const array of arrays)
    for (const value of array)
      if (Number.isFinite(value) && (!positive || value > 0)) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
  return low <= high ? [low, high] : positive ? [0.1, 1] : [0, 1];
}
