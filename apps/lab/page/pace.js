// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Scheduling of work during interaction: one request at a time, the newest one next.

import {Outdated} from './engine.js';

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
