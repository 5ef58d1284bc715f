// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Commands that reproduce each result of the page, shown below the result.

import {announce, copyText, element} from '../../../viewer/dom.js';
import {Outdated} from './engine.js';
import {codeWord} from './lab.js';

/** Displays the commands. */
export class Commands {
  constructor(lab, effort) {
    Object.assign(this, {lab, effort, timer: 0});
    this.strips =
        [...document.querySelectorAll('[data-command]')].map((place) => this.#strip(place));
    lab.listen((what) => what === 'state' && this.follow());
  }

  #strip(place) {
    const text = element('pre', {tabindex: 0, 'aria-label': 'Equivalent command'}),
          files = element('p', {class: 'files'});
    const copy = element(
        'button', {
          type: 'button',
          'aria-label': 'Copy the command',
          onclick: async () => {
            const isCopied = await copyText(text.textContent);
            copy.textContent = isCopied ? 'Copied' : 'Cannot copy';
            announce(
                isCopied ? 'Copied the command.' : 'The browser does not allow the page to copy.');
            setTimeout(() => {
              copy.textContent = 'Copy';
            }, 1500);
          }
        },
        'Copy');
    place.append(element('div', {class: 'strip'}, text, copy), files);
    return {what: place.dataset.command, text, files};
  }

  /** Requests the commands of the current state after a short pause without changes. */
  follow() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.#ask(), 60);
  }

  async #ask() {
    const {camera, codes, chosen, trials, seed, scene} = this.lab.state;
    const own =
        camera.file === undefined ? {built_in: camera.built_in} : {camera_file: camera.file_name};
    for (const {what, text, files} of this.strips) {
      const shown = what === 'design' ? [] : what === 'scene' ? [codes[chosen]] : codes;
      const asked = {
        what,
        ...own,
        changes: camera.changes,
        codes: shown.map(codeWord),
        trials,
        seed,
        scene: scene.name,
        filter: scene.filter,
        width: scene.width,
        signal: scene.signal,
        ambient: scene.ambient,
        effort: Number(this.effort.value)
      };
      try {
        const each =
            what === 'codes' ? asked.codes.map((code) => ({...asked, codes: [code]})) : [asked];
        const answers = await Promise.all(each.map(
            (one, i) =>
                this.lab.engine.call('command', one, {lane: `command ${what} ${i}`, rank: 6})));
        text.textContent = answers.map((answer) => answer.command).join('\n');
        const needed = [
          ...(own.camera_file ? [own.camera_file] : []),
          ...shown.filter((code) => code.file !== undefined).map(codeWord)
        ];
        files.textContent =
            needed.length ? `First save from this page: ${needed.join(', ')}.` : '';
      } catch (error) {
        if (!(error instanceof Outdated)) text.textContent = `no command: ${error.message}`;
      }
    }
  }
}
