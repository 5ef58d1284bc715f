// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Depth error by light level: the table of `tofsmith evaluate`, a map per code, curves with bounds.

import {Columns} from './codes.js';
import {scaleOf} from '../../../viewer/colour_bar.js';
import {seriesColour} from '../../../viewer/colours.js';
import {byId, drawSoon, element, showProblem} from '../../../viewer/dom.js';
import {HeatMap} from '../../../viewer/heat_map.js';
import {fixedText, rangeOf, rateText, shortText} from '../../../viewer/numbers.js';
import {LinePlot, paddedRange} from '../../../viewer/plot.js';

const trialChoices = [1000, 5000, 20000, 100000];
const bounds = [
  ['cramer_rao_mae_m', 'Cramer-Rao', '6 4'], ['receiver_bound_mae_m', 'receiver', '2 4'],
  ['direct_tof_bound_mae_m', 'direct ToF', '1 3']
];

/** A depth error and its standard error in millimetres, as `tofsmith evaluate` writes them. */
export const errorText = (mean, deviation) =>
    `${fixedText(1e3 * mean, 4)} \u00b1 ${fixedText(1e3 * deviation, 2)}`;

const distinct = (values) => [...new Set(values)];
const ambientOf = (one) => distinct(one.points.map((p) => p.ambient_e_per_s));

// Points at one ambient level. Results of the previous camera may have fewer levels.
function pointsAt(one, level) {
  const levels = ambientOf(one), ambient = levels[Math.min(level, levels.length - 1)];
  return one.points.filter((p) => p.ambient_e_per_s === ambient);
}

const least = (list, key) => list.reduce((best, one) => (one[key] < best[key] ? one : best));

/** The section of the page on depth errors. */
export class ErrorsView {
  constructor(lab) {
    this.lab = lab;
    this.maps = new Columns('map', () => new HeatMap());
    this.curves = new LinePlot();
    byId('error-curves').append(element('figure', {}, this.curves.root));
    const trials = byId('trials'), seed = byId('seed'), {store} = lab;
    trials.append(...trialChoices.map((count) => element('option', {value: count}, String(count))));
    trials.addEventListener('change', () => store.change((state) => {
      state.trials = Number(trials.value);
    }));
    seed.addEventListener('change', () => this.#setSeed(seed));
    byId('curve-ambient').addEventListener('change', (event) => store.change((state) => {
      state.curve_ambient = Number(event.target.value);
    }));
    lab.listen((what, i) => {
      if (what === 'state') this.#arrange();
      if (what === 'code' || what === 'problem') this.maps.pale(i, lab.slots[i].problem);
      if (what === 'state' || what === 'evaluation' || what === 'problem')
        drawSoon(this, () => this.#draw());
    });
  }

  #setSeed(input) {
    const isSeed = /^\d{1,15}$/.test(input.value.trim());
    showProblem(
        byId('error-problem'),
        isSeed ? '' : `seed: found ${input.value || 'nothing'}; expected an integer >= 0`, input);
    if (isSeed)
      this.lab.store.change((state) => {
        state.seed = Number(input.value);
      });
  }

  #arrange() {
    const {codes, trials, seed} = this.lab.state, select = byId('trials');
    this.maps.fit(codes.length);
    if (![...select.options].some((option) => Number(option.value) === trials))
      select.append(element('option', {value: trials}, String(trials)));
    select.value = String(trials);
    if (byId('seed').getAttribute('aria-invalid') !== 'true') byId('seed').value = seed;
  }

  // Available evaluations, with the indices of their codes.
  #known() {
    return this.lab.slots.slice(0, this.lab.state.codes.length)
        .map((slot, i) => ({i, document: slot.evaluation, one: slot.evaluation?.codes[0]}))
        .filter(({one}) => one);
  }

  #draw() {
    const known = this.#known(), {trials} = this.lab.state, kind = this.lab.errorKind;
    if (!known.length) return void (byId('error-progress').textContent = '');
    const done = Math.min(...known.map(({document}) => document.trials));
    byId('error-progress').textContent = `${done < trials ? `${done} of ` : ''}${trials} trials`;
    this.#drawTable(known, kind, trials);
    this.#drawMaps(known, kind);
    this.#drawCurves(known);
  }

  #drawTable(known, kind, trials) {
    const row = ({i, document, one}) => {
      const best = least(one.points, 'circular_mde_m');
      const light = `${rateText(best.signal_e_per_s)}, ${rateText(best.ambient_e_per_s)}`;
      const {problem} = this.lab.slots[i],
            cell = (text) =>
                element('td', problem || document.trials < trials ? {class: 'estimate'} : {}, text);
      return element(
          'tr', {'data-code': i},
          element(
              'th', {scope: 'row'},
              element('span', {class: 'row-dot', style: `background:${seriesColour(i)}`}),
              problem ? `${one.name}, last valid result` : one.name),
          cell(`${one.exposures} x ${one.taps}`),
          ...['linear', 'circular'].map(
              (which) =>
                  cell(errorText(one[which].geometric_mean_m, one[which].geometric_mean_se_m))),
          cell(errorText(best.circular_mde_m, best.circular_se_m)), cell(light),
          cell(fixedText(100 * Math.max(...one.points.map((p) => p.outlier_rate)), 3)));
    };
    const head = [
      'code', 'exposures x taps', 'linear (mm)', 'circular (mm)', 'lowest circular (mm)',
      'at signal, ambient (e/s)', 'max outliers (%)'
    ];
    const levels = known[0].one.points.length;
    const caption = `Geometric mean over ${levels} light levels; \u00b1 is one standard error. ` +
        `Designs for this camera minimize the ${kind} error.`;
    byId('error-table')
        .replaceChildren(element(
            'table', {}, element('caption', {}, element('span', {}, caption)),
            element(
                'thead', {},
                element('tr', {}, ...head.map((text) => element('th', {scope: 'col'}, text)))),
            element('tbody', {}, ...known.map(row))));
  }

  #drawMaps(known, kind) {
    const errors_mm = known.map(({one}) => one.points.map((p) => 1e3 * p[`${kind}_mde_m`]));
    const scale = scaleOf(
        {label: `${kind} depth error`, unit: 'mm', map: 'viridis', log: true, clip: 0}, errors_mm);
    const {scene} = this.lab.state;
    for (const {i, one} of known) {
      const signal = distinct(one.points.map((p) => p.signal_e_per_s)), ambient = ambientOf(one);
      const at = (c, r) => one.points[c * ambient.length + r];
      const values = ambient.flatMap((_, r) => signal.map((_, c) => 1e3 * at(c, r)?.[`${kind}_mde_m`]));
      this.maps.title(i, one.name);
      const c = signal.indexOf(scene.signal), r = ambient.indexOf(scene.ambient);
      this.maps.plots[i].show({
        label: `Map of the depth error of ${one.name}`,
        columns: signal.map(rateText),
        rows: ambient.map(rateText),
        values,
        colour: scale.colour,
        scale: scale.bar,
        cellText: (value) => shortText(value, 3),
        titles: {x: 'signal (e/s)', y: 'ambient (e/s)'},
        current: c >= 0 && r >= 0 ? [c, r] : null,
        details: (column, row) => {
          const p = at(column, row);
          return [
            `signal ${rateText(p.signal_e_per_s)}, ambient ${rateText(p.ambient_e_per_s)} e/s`,
            `error ${errorText(p[`${kind}_mde_m`], p[`${kind}_se_m`])} mm`,
            `root mean square ${errorText(p[`${kind}_rmse_m`], p[`${kind}_rmse_se_m`])} mm`,
            `outliers ${shortText(100 * p.outlier_rate, 3)} %`,
            `Cramer-Rao ${shortText(1e3 * p.cramer_rao_mae_m, 4)} mm`
          ];
        },
        choose: (column, row) => this.lab.store.change((state) => {
          Object.assign(state.scene, {signal: signal[column], ambient: ambient[row]});
          state.curve_ambient = row;
        }),
      });
    }
  }

  // Bounds always apply to the circular error.
  #drawCurves(known) {
    const ambient = ambientOf(known[0].one);
    const wanted = this.lab.state.curve_ambient ?? Math.floor(ambient.length / 2),
          level = Math.min(wanted, ambient.length - 1);
    const select = byId('curve-ambient'), texts = ambient.map((a) => `${shortText(a, 4)} e/s`);
    if ([...select.options].map((option) => option.textContent).join() !== texts.join())
      select.replaceChildren(...texts.map((text, value) => element('option', {value}, text)));
    select.value = String(level);
    const series = [];
    for (const {i, one} of known) {
      const points = pointsAt(one, level), x = points.map((p) => p.signal_e_per_s);
      const mean = points.map((p) => 1e3 * p.circular_mde_m),
            deviation = points.map((p) => 2e3 * p.circular_se_m);
      series.push({
        name: one.name,
        x,
        y: mean,
        colour: seriesColour(i),
        width: 2.2,
        band: [mean.map((v, n) => v - deviation[n]), mean.map((v, n) => v + deviation[n])]
      });
    }
    for (const {i, one} of known) {
      const points = pointsAt(one, level), x = points.map((p) => p.signal_e_per_s);
      for (const [key, name, dash] of i === known[0].i ? bounds : bounds.slice(0, 1))
        series.push({
          name: key === 'cramer_rao_mae_m' ? `${name} of ${one.name}` : `${name} bound`,
          x,
          y: points.map((p) => 1e3 * p[key]),
          colour: key === 'cramer_rao_mae_m' ? seriesColour(i) : 'var(--line)',
          width: 1.4,
          dash
        });
    }
    this.curves.show({
      label: `Circular depth error over signal at ambient light of ${texts[level]}, with bounds`,
      height: 320,
      x: {
        title: 'signal (e/s)',
        log: true,
        range: paddedRange(rangeOf(series.map((one) => one.x), true), true),
        text: (v) => `signal ${shortText(v, 4)} e/s`
      },
      y: {
        title: 'circular depth error (mm)',
        log: true,
        range: paddedRange(rangeOf(series.map((one) => one.y), true), true),
        unit: 'mm'
      },
      series,
    });
  }
}
