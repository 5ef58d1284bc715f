// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// State of the lab, with undo and redo.

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
