// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Arrays of documents: plain lists, or packed by src/report/figure_json.cpp.

async function inflated(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Decodes a list, with null for NaN, or a packed array {count, row, low, step, words}. */
export async function unpacked(array) {
  if (Array.isArray(array)) return Float64Array.from(array, (value) => value ?? NaN);
  const {count, row, low, step} = array, planes = await inflated(array.words);
  const values = new Float32Array(count);
  for (let i = 0, word = 0; i < count; ++i) {
    if (i % row === 0) word = 0;
    word = (word + planes[i] + 256 * planes[count + i]) & 0xffff;
    values[i] = word === 0 ? NaN : (word - 1 + low) * step;
  }
  return values;
}
