// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Colours of series and colour maps of values.

/** Returns the colour of the i-th series, for style attributes. */
export const seriesColour = (i) => `var(--s${i % 7})`;

/** Returns the dash pattern that distinguishes series of the same colour. */
export const seriesDash = (i) => ['', '7 4', '2 3', '8 3 2 3'][Math.floor(i / 7) % 4];

const viridis = [
  [68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140],
  [34, 168, 132], [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37]
];
const cividis = [
  [0, 34, 78], [18, 53, 112], [59, 73, 108], [87, 93, 109], [112, 113, 115], [138, 134, 120],
  [165, 156, 116], [195, 179, 105], [225, 204, 85], [254, 232, 56]
];
const diverging = [
  [8, 48, 107], [31, 110, 179], [107, 174, 214], [198, 220, 238], [247, 247, 245], [246, 208, 184],
  [236, 143, 96], [200, 67, 31], [122, 15, 10]
];

function between(stops, place) {
  const at = Math.min(1, Math.max(0, place)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(at));
  return stops[i].map((v, c) => Math.round(v + (at - i) * (stops[i + 1][c] - v)));
}

/** Returns red, green and blue at a position in [0, 1] of the map from dark blue to yellow. */
export const sequentialColour = (place) => between(viridis, place);

/** Returns red, green and blue at a position in [0, 1] of the map from blue over white to red. */
export const divergingColour = (place) => between(diverging, place);

/** Colour maps by their names in documents: functions of a position in [0, 1]. */
export const colourMaps = {
  viridis: sequentialColour,
  cividis: (place) => between(cividis, place),
  diverging: divergingColour
};

/** Converts red, green and blue to a CSS colour. */
export const cssColour = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

/** Returns true if text on this colour must be light. */
export const isDark = ([r, g, b]) => 0.299 * r + 0.587 * g + 0.114 * b < 130;
