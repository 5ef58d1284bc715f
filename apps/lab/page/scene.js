// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Captured and decoded scene: true depth, depth and error, unfiltered and filtered.

import {divergingColour, sequentialColour} from '../../../viewer/colours.js';
import {byId, element, showProblem} from '../../../viewer/dom.js';
import {askedCode} from './lab.js';
import {lengthText, rangeOf, shortText} from '../../../viewer/numbers.js';
import {Sharpener} from './engine.js';
import {Picture} from '../../../viewer/picture.js';

const widths = [80, 160, 240, 320], quickWidth = 80;

// 90th percentile of the absolute errors.
function spread(errors) {
  const sizes = Array.from(errors, Math.abs).filter(Number.isFinite).sort((a, b) => a - b);
  return sizes.length ? Math.max(1e-6, sizes[Math.floor(0.9 * (sizes.length - 1))]) : 1;
}

const barOf = (title, [low, high], colour) =>
    ({title, low: lengthText(low, 3), high: lengthText(high, 3), colour});

/** The scene section of the page. */
export class SceneView {
  constructor(lab, about) {
    this.lab = lab;
    const picture = () => new Picture();
    this.pictures = {
      truth: picture(),
      depth: picture(),
      error: picture(),
      plan: picture(),
      filtered: picture(),
      filteredError: picture()
    };
    byId('scene-pictures').append(...Object.values(this.pictures).map((one) => one.root));
    this.pictures.plan.root.id = 'scene-deviation';
    this.#controls(about);
    this.sharpener = new Sharpener(
        1, () => lab.engine.cancel('scene'),
        (error) => showProblem(byId('scene-problem'), error.message));
    lab.listen((what) => what === 'state' && this.#follow());
  }

  #controls(about) {
    const {store} = this.lab, put = (key, read) => (event) => {
      const text = event.target.value, value = read(text);
      showProblem(
          byId('scene-problem'),
          value === undefined ? `${key}: found ${text}; expected a number >= 0 or an empty field` :
                                '',
          event.target);
      if (value === undefined) return;
      store.change((state) => {
        state.scene[key] = value;
      });
    };
    const rate = (text) =>
        (text.trim() === ''                                     ? null :
             Number.isFinite(Number(text)) && Number(text) >= 0 ? Number(text) :
                                                                  undefined);
    const choice = (id, list, key, read) => element(
        'select', {id, onchange: put(key, read)},
        ...list.map((one) => element('option', {value: one}, String(one))));
    this.inputs = {
      name: choice('scene-name', about.scenes, 'name', String),
      filter: choice('scene-filter', about.filters, 'filter', String),
      width: choice('scene-width', widths, 'width', Number),
      signal: element(
          'input',
          {id: 'scene-signal', size: 8, placeholder: 'default', onchange: put('signal', rate)}),
      ambient: element(
          'input',
          {id: 'scene-ambient', size: 8, placeholder: 'default', onchange: put('ambient', rate)}),
    };
    const texts = {
      name: 'Scene',
      filter: 'Filter',
      width: 'Columns',
      signal: 'Signal (e/s)',
      ambient: 'Ambient (e/s)'
    };
    byId('scene-controls')
        .append(...Object.entries(this.inputs)
                    .map(([key, input]) => element('label', {}, texts[key], input)));
  }

  #follow() {
    const {state, camera} = this.lab, {scene} = state, code = state.codes[state.chosen];
    for (const [key, input] of Object.entries(this.inputs)) {
      if (input.tagName === 'SELECT' &&
          ![...input.options].some((option) => option.value === String(scene[key])))
        input.append(element('option', {value: scene[key]}, String(scene[key])));
      if (input !== document.activeElement || input.getAttribute('aria-invalid') !== 'true')
        input.value = scene[key] ?? '';
    }
    const key = JSON.stringify([camera.toml, code, scene, state.seed]);
    if (key === this.key) return;
    this.key = key;
    const shot = (width, isLong) => async () => {
      const asked = {
        camera: camera.toml,
        code: askedCode(code),
        scene: scene.name,
        seed: state.seed,
        width,
        signal: scene.signal,
        ambient: scene.ambient
      };
      const options = {lane: 'scene', isSlow: true, isLong, rank: 4}, {engine} = this.lab;
      const alone = await engine.call('scene', {...asked, filter: 'off'}, options);
      const filtered = await engine.call('scene', {...asked, filter: scene.filter}, options);
      if (key !== this.key && isLong) return;
      showProblem(byId('scene-problem'), '');
      this.#draw(alone, filtered, code, scene);
      byId('scene').dataset.width = width;
    };
    this.sharpener.request(
        scene.width > quickWidth ? [shot(quickWidth, false), shot(scene.width, true)] :
                                   [shot(scene.width, false)]);
  }

  #draw(alone, filtered, code, scene) {
    const [height, width] = alone.depth_m.shape, truth = alone.true_depth_m.values;
    const errors = alone.deviation_m.values, filteredErrors = filtered.deviation_m.values;
    const depths = rangeOf([truth]), most = spread(errors), name = code.name;
    const size = {width, height};
    const depthSpec = (values, title, note, label) => ({
      ...size,
      values,
      title,
      note,
      label,
      colour: (v) => sequentialColour((v - depths[0]) / (depths[1] - depths[0] || 1)),
      scale: barOf('depth', depths, sequentialColour),
      text: (v) => `${title} ${lengthText(v)}`
    });
    const errorSpec = (values, title, note, label) => ({
      ...size,
      values,
      title,
      note,
      label,
      colour: (v) => divergingColour(0.5 + v / most / 2),
      scale: barOf('decoded minus true', [-most, most], divergingColour),
      text: (v) => `${title} ${lengthText(v)}`
    });
    const mean = ({mean_error_m: error}) => `mean ${lengthText(error, 3)}`;
    const {pictures} = this, deviations = alone.standard_deviation_m.values,
          scale = [rangeOf([deviations])[0], 2 * spread(deviations)];
    pictures.truth.show(
        depthSpec(truth, 'True depth', scene.name, `True depth of the scene ${scene.name}`));
    pictures.depth.show(depthSpec(
        alone.depth_m.values, 'Depth', 'unfiltered',
        `Depth decoded with ${name}, unfiltered`));
    pictures.error.show(
        errorSpec(errors, 'Error', mean(alone), `Depth error, unfiltered, ${mean(alone)}`));
    pictures.plan.show({
      ...size,
      values: deviations,
      title: 'Predicted deviation',
      note: 'unfiltered',
      label: 'Standard deviation of depth, as predicted by the decoder',
      colour: (v) => sequentialColour((v - scale[0]) / (scale[1] - scale[0] || 1)),
      scale: barOf('deviation', scale, sequentialColour),
      text: (v) => `deviation ${lengthText(v)}`
    });
    pictures.filtered.show(depthSpec(
        filtered.depth_m.values, 'Depth', `filter ${scene.filter}`,
        `Depth decoded with ${name} and the filter ${scene.filter}`));
    pictures.filteredError.show(errorSpec(
        filteredErrors, 'Error', `${mean(filtered)}, filter ${scene.filter}`,
        `Depth error with the filter, ${mean(filtered)}`));
    const each = (text) => `${text(alone)} unfiltered, ${text(filtered)} filtered`;
    const share = ({ok_share: ok}) => `${shortText(100 * ok, 3)} %`;
    const rates =
        [alone.signal_e_per_s, alone.ambient_e_per_s].map((rate) => `${shortText(rate)} e/s`);
    byId('scene-figures').textContent =
        `Code ${name}; signal ${rates[0]}, ambient ${rates[1]} at the reference distance. ` +
        `Median error ${each((one) => lengthText(one.median_error_m, 3))}; ` +
        `pixels with status ok: ${each(share)}.`;
  }
}
