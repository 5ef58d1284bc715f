// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Workers that answer calls: several share the calls of the page, a separate one runs designs.
// During interaction, calls run one at a time, the newest one next.

/** Error of a call that was cancelled or replaced by a newer call of the same lane. */
export class Outdated extends Error {}

/** Error message of the engine, as the command would print it; `field` is the invalid key. */
export class Refused extends Error {
  constructor({message, field}) {
    super(message);
    this.field = field;
  }
}

// (module (func (result v128) i32.const 0 i8x16.splat i8x16.popcnt)): valid only with SIMD
// support.
const simdModule = Uint8Array.of(
    0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253,
    15, 253, 98, 11);

/** Describes the missing feature of an unsupported browser; null if it is supported. */
export function missingFeature() {
  if (typeof WebAssembly !== 'object')
    return 'This browser does not support WebAssembly, which the lab requires.';
  if (!WebAssembly.validate(simdModule))
    return 'This browser does not support SIMD in WebAssembly, which the lab requires. ' +
        'It is available in Chromium 91, Firefox 89, Safari 16.4 and later.';
  if (typeof DecompressionStream !== 'function' || typeof Worker !== 'function')
    return 'This browser is too old for the lab, which requires Chromium 123, Firefox 120 or ' +
        'Safari 17.5.';
  return null;
}

const decoded = (base64) => Uint8Array.fromBase64 ?
    Uint8Array.fromBase64(base64) :
    Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

/** Compiles the packed engine once; returns a function that starts a worker with it. */
export async function packedEngine() {
  const text = (id) => document.getElementById(id)?.textContent ?? '';
  const address = URL.createObjectURL(new Blob([text('lab-worker')], {type: 'text/javascript'}));
  const base64 = text('lab-wasm');
  let start = null;
  if (base64) {
    const stream =
        new Blob([decoded(base64)]).stream().pipeThrough(new DecompressionStream('gzip'));
    start = await WebAssembly.compile(await new Response(stream).arrayBuffer());
    document.getElementById('lab-wasm').textContent = '';
  }
  return () => {
    const worker = new Worker(address);
    worker.postMessage({start});
    return worker;
  };
}

/** Pool of workers with a queue of calls. */
export class Engine {
  #startWorker;
  #workers = [];
  #waiting = [];
  #nextId = 1;

  /** @param startWorker  returns a new worker; @param size  number of workers */
  constructor(startWorker, size) {
    this.#startWorker = startWorker;
    for (let i = 0; i < size; ++i)
      this.#workers.push(this.#started({isSwift: size > 1 && i === 0}));
  }

  /**
   * Calls the engine; a newer call of the same lane replaces this one.
   * @param options  lane; isSlow: must leave one worker free; isLong: is stopped when replaced;
   *                 rank: lower ranks first; onProgress
   * @returns {Promise<object>} the answer, in which descriptions of arrays are replaced by typed
   *     arrays
   */
  call(name, values, options = {}) {
    const {lane} = options;
    if (lane) this.cancel(lane);
    return new Promise((resolve, reject) => {
      const call = {
        message: {...values, id: this.#nextId++, call: name},
        resolve,
        reject,
        rank: 0,
        ...options
      };
      const place = this.#waiting.findIndex((other) => other.rank > call.rank);
      this.#waiting.splice(place < 0 ? this.#waiting.length : place, 0, call);
      this.#serve();
    });
  }

  /** Cancels all calls of a lane; long calls are stopped immediately. */
  cancel(lane) {
    for (const call of this.#waiting.filter((waiting) => waiting.lane === lane))
      call.reject(new Outdated());
    this.#waiting = this.#waiting.filter((waiting) => waiting.lane !== lane);
    for (const worker of this.#workers)
      if (worker.call?.lane === lane) {
        worker.call.reject(new Outdated());
        if (worker.call.isLong) this.#restart(worker);
      }
    this.#serve();
  }

  /** True if no call runs or waits. */
  get isIdle() {
    return !this.#waiting.length && this.#workers.every((worker) => !worker.call);
  }

  /** Stops everything. */
  close() {
    for (const worker of this.#workers) {
      worker.call?.reject(new Outdated());
      worker.thread.terminate();
    }
    this.#workers = [];
    for (const call of this.#waiting) call.reject(new Outdated());
    this.#waiting = [];
  }

  #started(worker) {
    worker.call = null;
    worker.isReady = false;
    worker.thread = this.#startWorker();
    worker.thread.onmessage = ({data}) => this.#heard(worker, data);
    worker.thread.onerror = (event) => {
      event.preventDefault();
      this.#failed(worker, event.message || 'the engine stopped');
    };
    return worker;
  }

  #restart(worker) {
    worker.thread.terminate();
    this.#started(worker);
  }

  #failed(worker, message) {
    const {call} = worker;
    if (!worker.isReady) {  // a restart would fail, too
      worker.failure = message;
      for (const waiting of this.#waiting.splice(0)) waiting.reject(new Error(message));
      return;
    }
    this.#restart(worker);
    call?.reject(new Error(message));
    this.#serve();
  }

  #heard(worker, data) {
    if (data.ready) worker.isReady = true;
    const {call} = worker;
    if (data.error && !worker.isReady) return this.#failed(worker, data.error.message);
    if (call && data.id === call.message.id) {
      if (data.progress) return call.onProgress?.(data.progress);
      worker.call = null;
      if (data.error?.fatal) this.#restart(worker);  // internal error of the engine
      if (data.error)
        call.reject(new Refused(data.error));
      else
        call.resolve(withArrays(data.answer, data.arrays ?? {}));
    }
    this.#serve();
  }

  #serve() {
    for (const worker of this.#workers) {
      if (worker.failure && this.#waiting.length) {
        for (const waiting of this.#waiting.splice(0)) waiting.reject(new Error(worker.failure));
        return;
      }
      if (worker.call || !worker.isReady) continue;
      const place =
          this.#waiting.findIndex((call) => !((call.isSlow || call.isLong) && worker.isSwift));
      if (place < 0) continue;
      worker.call = this.#waiting.splice(place, 1)[0];
      worker.thread.postMessage(worker.call.message);
    }
  }
}

function withArrays(answer, arrays) {
  const filled = {...answer};
  for (const [key, value] of Object.entries(filled))
    if (value && typeof value === 'object' && value.array in arrays)
      filled[key] = {values: arrays[value.array], shape: value.shape};
  return filled;
}

/**
 * Returns a function that runs `work`, never concurrently. Of waiting calls with the same first
 * argument, only the newest is kept.
 */
export function newestOnly(work) {
  const waiting = new Map();
  let isBusy = false;
  return async (...values) => {
    waiting.set(values[0], values);
    if (isBusy) return;
    isBusy = true;
    try {
      while (waiting.size) {
        const [first, next] = waiting.entries().next().value;
        waiting.delete(first);
        await work(...next);
      }
    } finally {
      isBusy = false;
    }
  };
}

/**
 * Renders a coarse image first and then refines it. Each request is a list of steps, i.e. functions
 * that return promises. The first `whole` steps are always completed, so that there is an image
 * even if requests arrive quickly. A newer request cancels the other steps.
 */
export class Sharpener {
  #next = null;
  #isBusy = false;

  /** @param whole  number of steps to complete; @param stop  cancels the current step */
  constructor(whole, stop, onProblem) {
    Object.assign(this, {whole, stop, onProblem, place: 0});
  }

  /** Replaces the steps. */
  async request(steps) {
    this.#next = steps;
    if (this.#isBusy) {
      if (this.place >= this.whole) this.stop();
      return;
    }
    this.#isBusy = true;
    while (this.#next) {
      const now = this.#next;
      this.#next = null;
      try {
        for (this.place = 0; this.place < now.length && (this.place < this.whole || !this.#next);
             ++this.place)
          await now[this.place]();
      } catch (error) {
        if (!(error instanceof Outdated)) this.onProblem(error);
      }
    }
    this.#isBusy = false;
  }
}
