// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Dropped or selected files: cameras as TOML, codes as JSON.

import {announce, byId, notice} from '../../../viewer/dom.js';
import {askedCode} from './lab.js';

/** Larger files are rejected without reading them. */
export const maxFileBytes = 64 * 2 ** 20;

const sizeText = (bytes) =>
    (bytes >= 1e9 ? `${(bytes / 1e9).toFixed(1)} GB` : `${(bytes / 1e6).toFixed(1)} MB`);

/** Loads dropped and selected files into the lab. */
export class Files {
  constructor(lab) {
    this.lab = lab;
    const input = byId('files'), drop = byId('drop');
    byId('open').addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      this.take([...input.files]);
      input.value = '';
    });
    const holdsFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes('Files');
    addEventListener('dragenter', (event) => {
      if (holdsFiles(event)) drop.hidden = false;
    });
    addEventListener('dragover', (event) => {
      if (holdsFiles(event)) event.preventDefault();
    });
    addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) drop.hidden = true;
    });
    addEventListener('drop', (event) => {
      drop.hidden = true;
      if (!holdsFiles(event)) return;
      event.preventDefault();
      this.take([...event.dataTransfer.files]);
    });
  }

  /** Loads files one by one; all errors are reported together. */
  async take(files) {
    const problems = [];
    for (const file of files) {
      try {
        await this.#takeOne(file);
        announce(`${file.name} was loaded.`);
      } catch (error) {
        problems.push(`${file.name}: ${error.message}`);
      }
    }
    notice(problems.join('\n'));
  }

  async #takeOne(file) {
    if (file.size > maxFileBytes)
      throw new Error(
          `found ${sizeText(file.size)}; expected at most ${sizeText(maxFileBytes)}`);
    if (file.size === 0)
      throw new Error('found an empty file; expected a camera (TOML) or a code (JSON)');
    const bytes = new Uint8Array(await file.arrayBuffer());
    if (bytes.subarray(0, 4096).includes(0))
      throw new Error('found a binary file; expected a camera (TOML) or a code (JSON)');
    let text;
    try {
      text = new TextDecoder('utf-8', {fatal: true}).decode(bytes);
    } catch {
      throw new Error('found text that is not UTF-8; expected a camera (TOML) or a code (JSON)');
    }
    if (/^\s*\{/.test(text))
      await this.#takeCode(file, text);
    else
      await this.#takeCamera(file, text);
  }

  async #takeCode(file, text) {
    const {camera, engine} = this.lab;
    if (!camera) throw new Error('found no camera for this code; wait until the lab has started');
    const answer = await engine.call('code', {camera: camera.toml, code: askedCode({file: text})});
    this.lab.addCode({name: answer.name || file.name.replace(/(\.code)?\.json$/i, ''), file: text});
  }

  async #takeCamera(file, text) {
    await this.lab.engine.call('camera', {camera: text, changes: []});
    this.lab.store.change((state) => {
      state.camera = {file: text, file_name: file.name, changes: []};
    });
  }
}
