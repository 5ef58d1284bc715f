// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Design of a code for the camera, in a separate worker.

import {announce, byId, element, showProblem} from '../../../viewer/dom.js';
import {Engine, Outdated} from './engine.js';
import {lengthText} from '../../../viewer/numbers.js';

const efforts = [['0', 'known codes only'], ['0.1', 'quick'], ['0.3', 'short'], ['1', 'default']];

/** The design section of the page. */
export class DesignView {
  constructor(lab, startWorker) {
    Object.assign(this, {lab, startWorker, engine: null});
    this.effort = element(
        'select', {id: 'design-effort'},
        ...efforts.map(([value, text]) => element('option', {value}, `${value}: ${text}`)));
    this.effort.value = '0.1';
    this.start = element(
        'button', {type: 'button', id: 'design-start', class: 'main', onclick: () => this.#run()},
        'Design');
    this.cancel = element(
        'button',
        {type: 'button', id: 'design-cancel', disabled: true, onclick: () => this.#stop()},
        'Cancel');
    this.bar = element(
        'progress', {max: 1, value: 0, hidden: true, 'aria-label': 'Progress of the design'});
    this.text = element('span', {class: 'progress', id: 'design-text'});
    this.problem = element('p', {class: 'problem', role: 'alert', hidden: true});
    this.explanation = element('div', {class: 'figures', id: 'design-explanation'});
    byId('design-controls').after(this.explanation);
    byId('design-controls')
        .append(
            element('label', {}, 'Effort', this.effort), this.start, this.cancel, this.bar,
            this.text, this.problem);
  }

  #busy(isBusy) {
    this.start.disabled = isBusy;
    this.cancel.disabled = !isBusy;
    this.bar.hidden = !isBusy;
    byId('design').setAttribute('aria-busy', String(isBusy));
    if (isBusy)
      this.cancel.focus();
    else if (document.activeElement === document.body || document.activeElement === this.cancel)
      this.start.focus();
  }

  async #run() {
    if (this.engine || !this.lab.camera) return;
    showProblem(this.problem, '');
    this.text.textContent = 'starting';
    this.explanation.replaceChildren();
    this.bar.removeAttribute('value');
    this.engine = new Engine(this.startWorker, 1);
    this.#busy(true);
    announce('The design has started.');
    try {
      const asked = {
        camera: this.lab.camera.toml,
        effort: Number(this.effort.value),
        seed: this.lab.state.seed
      };
      const answer = await this.engine.call(
          'design', asked, {onProgress: (progress) => this.#follow(progress)});
      const {name} = answer;
      this.lab.addCode({name, file: answer.file});
      const error =
          Number.isFinite(answer.error_m) ? `depth error ${lengthText(answer.error_m)}` : '';
      this.text.textContent = `${name}: ${error}`;
      this.explanation.replaceChildren(
          ...answer.explanation.map((text) => element('p', {}, text)));
      announce(`The design is finished: ${name}, ${error}.`);
    } catch (error) {
      this.text.textContent = error instanceof Outdated ? 'cancelled; nothing changed' : '';
      if (error instanceof Outdated)
        announce('The design was cancelled; nothing changed.');
      else
        showProblem(this.problem, error.message);
    }
    this.engine?.close();
    this.engine = null;
    this.#busy(false);
  }

  #stop() {
    this.engine?.close();
  }

  #follow({done, total, text}) {
    if (total > 0) this.bar.value = Math.min(1, done / total);
    this.text.textContent = text ?? '';
  }
}
