// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Work that keeps up with a hand: one piece at a time, always the newest request next.

import {Outdated} from './engine.js';

/**
 * A function that runs `work`, never twice at once; of calls that wait with the same first argument
 * only the newest is left.
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
 * A picture that is quick at first and then sharpens. Each request is a list of steps, functions
 * that return promises. The first `whole` ones are always finished, so that a picture follows
 * however fast requests come; the rest is given up for a newer request.
 */
export class Sharpener {
  #next = null;
  #isBusy = false;

  /** @param whole  steps that are finished; @param stop  gives up the step under way */
  constructor(whole, stop, onProblem) {
    Object.assign(this, {whole, stop, onProblem, place: 0});
  }

  /** Asks for other steps. */
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

  /** Whether nothing is under way or waits. */
  get isIdle() {
    return !this.#isBusy;
  }
}
