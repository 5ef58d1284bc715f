// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// State of the lab, with undo and redo, and links that hold it.

/** Initial state. */
export const firstState = () => ({
  camera: {built_in: 'indoor', changes: []},  // or {file: TOML text, file_name, changes}
  codes: [{name: 'hamiltonian-k4'}, {name: 'sinusoid-k4'}],  // or {file: JSON text, name}
  chosen: 0,
  trials: 20000,
  seed: 1,
  curve_ambient: null,  // index of the ambient level of the curves; null: the middle one
  scene: {name: 'table-top', filter: 'normal', width: 160, signal: 1e7, ambient: 1e6},
});

/** Maximum number of codes. */
export const maxCodes = 4;

const isText = (value) => typeof value === 'string';
const isAt = (value, low, high) => Number.isInteger(value) && value >= low && value <= high;
const isRate = (value) => value === null || (Number.isFinite(value) && value >= 0);

/** Returns the error of an imported state; null if it is valid. */
export function problemOf(state) {
  const {camera, codes, scene} = state ?? {};
  if (!camera || (isText(camera.built_in) === isText(camera.file)) ||
      !Array.isArray(camera.changes) ||
      !camera.changes.every(
          (change) => isText(change?.key) && (change.value === null || isText(change.value))))
    return 'its camera';
  if (!Array.isArray(codes) || !isAt(codes.length, 1, maxCodes) ||
      !codes.every((code) => isText(code?.name) && (code.file === undefined || isText(code.file))))
    return 'its codes';
  if (!isAt(state.chosen, 0, codes.length - 1)) return 'its chosen code';
  if (!isAt(state.trials, 2, 4e9) || !isAt(state.seed, 0, Number.MAX_SAFE_INTEGER))
    return 'its trials or seed';
  if (state.curve_ambient !== null && !isAt(state.curve_ambient, 0, 1e6))
    return 'its ambient level';
  if (!isText(scene?.name) || !isText(scene.filter) || !isAt(scene.width, 8, 1000) ||
      !isRate(scene.signal) || !isRate(scene.ambient))
    return 'its scene';
  return null;
}

/** State that is replaced as a whole; listeners are called after every change. */
export class Store {
  #past = [];
  #future = [];
  #merge = null;
  #listeners = [];

  constructor(state) {
    this.state = state;
  }

  /** Calls `listener(state)` after every change. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  /**
   * Applies `change(copy)` to a copy of the state, and replaces the state by it.
   * @param merge  consecutive changes with the same value are undone together
   */
  change(change, merge = null) {
    const next = structuredClone(this.state);
    change(next);
    if (JSON.stringify(next) === JSON.stringify(this.state)) return;
    if (!merge || merge !== this.#merge) this.#past.push(this.state);
    if (this.#past.length > 300) this.#past.shift();
    this.#merge = merge;
    this.#future = [];
    this.#put(next);
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  /** Undoes one change. */
  undo() {
    this.#step(this.#past, this.#future);
  }

  /** Redoes one change. */
  redo() {
    this.#step(this.#future, this.#past);
  }

  #step(from, to) {
    if (!from.length) return;
    to.push(this.state);
    this.#merge = null;
    this.#put(from.pop());
  }

  #put(state) {
    this.state = state;
    for (const listener of this.#listeners) listener(state);
  }
}

// Links hold the state in the fragment of a URL: a version, a dot, and deflated JSON in base64url.

/** Version of links; other versions are rejected. */
export const linkVersion = 1;

const maxLink = 1e5;   // characters; longer URLs may be truncated by other programs
const maxState = 2e6;  // maximum number of unpacked characters of JSON

async function through(bytes, stream) {
  return new Response(new Blob([bytes]).stream().pipeThrough(stream));
}

/** Returns the state as fragment of a URL, including `#`; null if it is too long. */
export async function linkOf(state) {
  const json = new TextEncoder().encode(JSON.stringify(state));
  const packed = new Uint8Array(
      await (await through(json, new CompressionStream('deflate-raw'))).arrayBuffer());
  if (packed.length > maxLink) return null;
  let binary = '';
  for (const byte of packed) binary += String.fromCharCode(byte);
  return `#${linkVersion}.` +
      btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

async function limitedText(response) {
  const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
  let text = '';
  for (;;) {
    const {value, done} = await reader.read();
    if (done) return text;
    text += value;
    if (text.length > maxState) {
      await reader.cancel();
      throw new Error('too long');
    }
  }
}

/**
 * Decodes a link.
 * @returns {Promise<{state?: object, problem?: string}>} neither if there is no link
 */
export async function stateOf(hash) {
  if (hash.length < 2) return {};
  const found = /^#(\d+)\.([\w-]*)$/.exec(hash);
  if (!found)
    return {problem: 'This is not a link of the lab; the lab starts in its initial state.'};
  if (Number(found[1]) !== linkVersion)
    return {
      problem:
          `This link has version ${found[1]}; expected ${linkVersion}. The lab starts in its ` +
          'initial state.'
    };
  try {
    const binary = atob(found[2].replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
    const state =
        JSON.parse(await limitedText(await through(bytes, new DecompressionStream('deflate-raw'))));
    const problem = problemOf(state);
    return problem ?
        {problem: `This link is damaged (${problem}); the lab starts in its initial state.`} :
        {state};
  } catch {
    return {problem: 'This link is damaged or truncated; the lab starts in its initial state.'};
  }
}
