// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Model of the page: its state, the camera and codes derived from it, and listeners.

import {newestOnly, Outdated, Refused, Sharpener} from './engine.js';
import {maxCodes} from './store.js';

const quickTrials = 200, middleTrials = 2000;
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/** Error message for the user; null if the answer is merely outdated. */
export const problemText = (error) => (error instanceof Outdated ? null : error.message);

/** Camera arguments of a request to the engine. */
export const cameraRequest = ({built_in, file, changes}) =>
    ({...(file === undefined ? {built_in} : {camera: file}), changes});

/** Results of one of up to four codes. */
class Slot {
  code = null;        // answer of `code`
  evaluation = null;  // document of `evaluate`
  problem = null;
  key = null;
}

/** The lab. Listeners: camera(), code(i), evaluation(i), scene(), problem(i). */
export class Lab {
  slots = Array.from({length: maxCodes}, () => new Slot());
  camera = null;     // answer of `camera`
  firstFields = [];  // of the unmodified camera
  gesture = 0;
  #answers = new Map();
  #listeners = [];

  constructor(store, engine) {
    this.store = store;
    this.engine = engine;
    this.sharpeners = this.slots.map(
        (slot, i) =>
            new Sharpener(2, () => engine.cancel(`code-${i}`), (error) => this.#failed(i, error)));
    this.update = newestOnly(() => this.#update());
    this.setNewest = newestOnly((...asked) => this.#set(...asked));
    this.moveNewest = newestOnly((...asked) => this.#moveEdge(...asked));
    store.listen(() => this.update());
  }

  get state() {
    return this.store.state;
  }

  /** Calls `listener(what, i)` when there is a new result. */
  listen(listener) {
    this.#listeners.push(listener);
  }

  #tell(what, i) {
    if (what === 'code')
      performance.mark('tofsmith picture');  // for measurements of latency
    for (const listener of this.#listeners) listener(what, i);
  }

  async #cameraOf(camera) {
    const request = cameraRequest(camera), known = this.#answers.get(JSON.stringify(request));
    return known ?? this.#remember(camera, await this.engine.call('camera', request));
  }

  #remember(camera, answer) {
    if (this.#answers.size > 60) this.#answers.delete(this.#answers.keys().next().value);
    this.#answers.set(JSON.stringify(cameraRequest(camera)), answer);
    return answer;
  }

  async #update() {
    const {state} = this;
    try {
      const camera = await this.#cameraOf(state.camera);
      this.firstFields = (await this.#cameraOf({...state.camera, changes: []})).fields;
      if (this.camera?.toml !== camera.toml) this.camera = camera;
      this.#tell('camera');
    } catch (error) {
      this.#tell('camera problem', problemText(error));
      if (!this.camera) return;
    }
    this.slots.forEach((slot, i) => this.#follow(slot, i, state));
    this.#tell('state');
  }

  #follow(slot, i, {codes, trials, seed}) {
    const code = codes[i], camera = this.camera.toml;
    const key = code && JSON.stringify([camera, code, trials, seed]);
    if (slot.key === key) return;
    slot.key = key;
    if (!code) {
      Object.assign(slot, {code: null, evaluation: null, problem: null, source: null});
      this.sharpeners[i].request([]);
      return;
    }
    const source = JSON.stringify([camera, code]), lane = `code-${i}`,
          asked = {camera, code: askedCode(code)};
    const evaluate = (count, rank) => async () => {
      const isLong = count > middleTrials, isSlow = count > quickTrials;
      const {document} = await this.engine.call(
          'evaluate', {...asked, trials: count, seed}, {lane, isSlow, isLong, rank});
      if (slot.key !== key && isLong) return;
      slot.evaluation = document;
      this.#tell('evaluation', i);
    };
    const steps = [async () => {
      if (slot.source === source) return;
      slot.code = await this.engine.call('code', asked, {lane});
      Object.assign(slot, {source, problem: null});
      this.#tell('code', i);
    }];
    [quickTrials, middleTrials]
        .filter((count) => count < trials)
        .forEach((count, rank) => steps.push(evaluate(count, rank + 1)));
    steps.push(evaluate(trials, 3));
    this.sharpeners[i].request(steps);
  }

  #failed(i, error) {
    const slot = this.slots[i];
    Object.assign(slot, {problem: error.message, source: null});
    if (slot.code && !this.state.codes[i]) slot.code = null;
    this.#tell('problem', i);
  }

  /** Sets a key of the camera, then calls `heard(problem)`; null: success. */
  set(key, text, heard) {
    this.setNewest(key, text, heard, this.gesture);
  }

  /** Moves an edge of the i-th code, starting from `code`. */
  moveEdge(i, code, edge) {
    this.moveNewest(i, code, edge, this.gesture);
  }

  /** Ends a gesture: later changes are undone separately. */
  settle() {
    ++this.gesture;
  }

  async #set(key, text, heard, gesture) {
    try {
      const {camera} = this, field = camera.fields.find((one) => one.key === key);
      const value =
          text === '' && field?.default === null ? undefined : text;  // removes the key
      const answer = await this.engine.call('set', {camera: camera.toml, key, value});
      const change = answer.change ?? {key, value: value ?? null};
      const first = new Map(this.firstFields.map((field) => [field.key, field.value]));
      const isFirst = answer.fields.every(
          (one) => one.key !== change.key || same(one.value, first.get(one.key)));
      const kept = this.state.camera.changes.filter(
          (old) => old.key !== change.key && !old.key.startsWith(change.key + '.'));
      const changes = isFirst && first.has(change.key) ? kept : [...kept, change];
      this.#remember({...this.state.camera, changes}, answer);
      this.store.change((state) => {
        state.camera.changes = changes;
      }, `set ${key} ${gesture}`);
      heard(null);
      await this.update();
    } catch (error) {
      if (error instanceof Outdated) return;
      heard(
          error instanceof Refused && error.field && error.field !== key ?
              `${error.field}: ${error.message}` :
              error.message);
    }
  }

  /** Resets a key to its value in the unmodified camera. */
  reset(key) {
    this.store.change((state) => {
      const parts = key.split('.').map((_, i, all) => all.slice(0, i + 1).join('.'));
      state.camera.changes = state.camera.changes.filter((change) => !parts.includes(change.key));
    });
  }

  async #moveEdge(i, code, {arm, measurement, edge, position}, gesture) {
    try {
      const answer = await this.engine.call(
          'move_edge',
          {camera: this.camera.toml, code: askedCode(code), arm, measurement, edge, position});
      this.store.change((state) => {
        if (state.codes[i]) state.codes[i] = {name: answer.name, file: answer.file};
      }, `edge ${i} ${arm} ${measurement} ${edge} ${gesture}`);
      await this.update();
    } catch (error) {
      if (!(error instanceof Outdated)) this.#tell('edge problem', error.message);
    }
  }

  /** Adds a code; if there are four already, it replaces the selected one. */
  addCode(code) {
    this.store.change((state) => {
      if (state.codes.length < maxCodes)
        state.codes.push(code);
      else
        state.codes[state.chosen] = code;
      state.chosen = state.codes.length < maxCodes || state.codes.at(-1) === code ?
          state.codes.indexOf(code) :
          state.chosen;
    });
  }

  /** The kind of error in the camera's operating range: linear or circular. */
  get errorKind() {
    return this.camera?.fields.find((field) => field.key === 'operating.error')?.value ??
        'circular';
  }
}

/** Code argument of a request to the engine. */
export const askedCode = (code) =>
    (code.file === undefined ? {name: code.name} : {file: code.file});

/** Name of a file of this code, or the name of its family. */
export const codeWord = (code) =>
    (code.file === undefined ? code.name : `${fileName(code.name)}.code.json`);

/** Converts a name to a valid file name. */
export const fileName = (name) =>
    name.replace(/[^\w.+-]+/g, '-').replace(/^[-.]+/, '').slice(0, 80) || 'unnamed';
