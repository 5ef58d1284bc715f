// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Codes side by side: names, waveforms, correlation functions and coding curves.

import {cssColour, sequentialColour, seriesColour, seriesDash} from '../../../viewer/colours.js';
import {announce, byId, element, saveText, showProblem} from '../../../viewer/dom.js';
import {rangeOf, shortText, thinned} from '../../../viewer/numbers.js';
import {LinePlot, paddedRange} from '../../../viewer/plot.js';
import {Space, SpaceView} from '../../../viewer/space.js';
import {askedCode, codeWord} from './lab.js';
import {maxCodes} from './store.js';
import {WaveformPlot} from './waveform_plot.js';

/** One figure per code in a row of the page; `make()` returns its plot. */
export class Columns {
  constructor(part, make) {
    this.place = document.querySelector(`[data-part="${part}"]`);
    this.plots = [];
    this.figures = Array.from({length: maxCodes}, (_, i) => {
      const plot = make(i), caption = element('figcaption');
      this.plots.push(plot);
      return {
        root: element('figure', {style: `--colour:${seriesColour(i)}`}, caption, plot.root),
        caption
      };
    });
  }

  /** Adapts the number of figures to the number of codes. */
  fit(count) {
    this.place.style.setProperty('--codes', count);
    const wanted = this.figures.slice(0, count).map((figure) => figure.root);
    if (wanted.length !== this.place.children.length) this.place.replaceChildren(...wanted);
  }

  /** Marks a figure as outdated if there is a problem. */
  pale(i, problem) {
    this.figures[i].root.classList.toggle('pale', Boolean(problem));
  }

  /** Writes the caption of a figure. */
  title(i, name, note = '') {
    this.figures[i].caption.replaceChildren(
        element('span', {class: 'dot'}), element('span', {}, name), element('small', {}, note));
  }
}

const mostPoints = 2048;  // maximum number of points of a line

const rowOf = ({values, shape}, k) => values.subarray(k * shape[1], (k + 1) * shape[1]);

function correlationSpec(code) {
  const [count, samples] = code.correlation.shape;
  const depth =
      thinned(Array.from({length: samples}, (_, n) => n / samples * code.range_m), mostPoints);
  return {
    label: `Correlation functions of ${code.name} over depth`,
    height: 210,
    x: {title: 'depth (m)', range: [0, code.range_m], unit: 'm'},
    y: {title: 'correlation', range: paddedRange(rangeOf([code.correlation.values]))},
    series: Array.from({length: count}, (_, k) => ({
                                          name: String(k + 1),
                                          x: depth,
                                          y: thinned(rowOf(code.correlation, k), mostPoints),
                                          colour: seriesColour(k),
                                          dash: seriesDash(k)
                                        })),
  };
}

function centred({values}) {
  const step = Math.ceil(values.length / 3 / mostPoints);
  const points = Float64Array.from(values).filter((_, i) => Math.floor(i / 3) % step === 0),
        count = points.length / 3;
  for (let axis = 0; axis < 3; ++axis) {
    let mean = 0;
    for (let i = axis; i < points.length; i += 3) mean += points[i] / count;
    for (let i = axis; i < points.length; i += 3) points[i] -= mean;
  }
  return points;
}

function radiusOf(points) {
  let radius = 0;
  for (let i = 0; i < points.length; i += 3)
    radius = Math.max(radius, Math.hypot(points[i], points[i + 1], points[i + 2]));
  return radius;
}

const axesOf = (length) => [0, 1, 2].map((axis) => {
  const end = [0, 0, 0];
  end[axis] = length;
  return {title: `axis ${axis + 1}`, from: end.map((value) => -value), to: end};
});

/** The part of the page that shows codes. */
export class CodesView {
  constructor(lab, about) {
    Object.assign(this, {lab, about, shape: ''});
    this.waveforms = new Columns('waveforms', () => new WaveformPlot());
    this.correlation = new Columns('correlation', () => new LinePlot());
    this.view = new SpaceView();  // shared, so that all curves rotate together
    this.curves = new Columns('curve', () => new Space());
    this.cards = [];
    byId('find-code').addEventListener('click', () => {
      byId('design-effort').value = '0';
      byId('design-start').click();
    });
    lab.listen((what, i) => {
      if (what === 'state') this.#arrange();
      if (what === 'code') this.#draw(i);
      if (what === 'code' || what === 'problem') this.#describe(i);
      if (what === 'code' || what === 'problem') this.#mark(i);
      if (what === 'edge problem') announce(i);
    });
  }

  // A camera with three taps, for example, supports only a few families.
  #offerDesign() {
    const slots = this.lab.slots.slice(0, this.lab.state.codes.length);
    byId('no-code').hidden = !slots.every((slot) => slot.problem);
  }

  // After an error the last valid figures stay visible, but pale.
  #mark(i) {
    this.#offerDesign();
    for (const columns of [this.waveforms, this.correlation, this.curves])
      columns.pale(i, this.lab.slots[i].problem);
  }

  #arrange() {
    const {codes, chosen} = this.lab.state;
    for (const columns of [this.waveforms, this.correlation, this.curves])
      columns.fit(codes.length);
    for (let i = codes.length; i < maxCodes; ++i) this.curves.plots[i].show(null);
    const shape =
        JSON.stringify([codes.map((code) => [code.name, code.file === undefined]), chosen]);
    if (shape === this.shape) return;
    this.shape = shape;
    const focus = document.activeElement?.id;
    this.cards = codes.map((code, i) => this.#card(code, i, i === chosen, codes.length));
    byId('code-slots')
        .replaceChildren(
            ...this.cards.map((card) => card.root),
            ...(codes.length < maxCodes ? [this.#adder()] : []));
    if (focus) byId(focus)?.focus({preventScroll: true});
    codes.forEach((_, i) => this.#describe(i));
    this.#drawCurves();
  }

  #adder() {
    return element(
        'button', {
          type: 'button',
          class: 'add',
          id: 'add-code',
          onclick: () => {
            const used = new Set(this.lab.state.codes.map((code) => code.name));
            const {families} = this.about;
            this.lab.addCode({name: families.find((name) => !used.has(name)) ?? families[0]});
          }
        },
        '+ Code');
  }

  #card(code, i, isChosen, count) {
    const {store} = this.lab;
    const put = (next) => store.change((state) => {
      state.codes[i] = next;
    });
    const names = this.about.families;
    const own = code.file !== undefined || !names.includes(code.name);
    const other = element('input', {
      class: 'other',
      id: `other-${i}`,
      hidden: true,
      'aria-label': `Name of the family of code ${i + 1}`,
      placeholder: 'hamiltonian-k7',
      spellcheck: 'false',
      onchange: () => other.value.trim() && put({name: other.value.trim()})
    });
    const select = element(
        'select', {
          id: `family-${i}`,
          'aria-label': `Code ${i + 1}`,
          'aria-describedby': `facts-${i}`,
          onchange: () => {
            if (select.value === '?') {
              other.hidden = false;
              other.focus();
            } else if (select.value !== '!')
              put({name: select.value});
          }
        },
        ...(own ? [element('option', {value: '!'}, code.name)] : []),
        ...names.map((name) => element('option', {value: name}, name)),
        element('option', {value: '?'}, 'another family\u2026'));
    select.value = own ? '!' : code.name;
    const facts = element('p', {class: 'facts', id: `facts-${i}`}),
          problem = element('p', {class: 'problem', role: 'alert', hidden: true});
    const pick = element('input', {
      type: 'radio',
      name: 'chosen',
      id: `chosen-${i}`,
      onchange: () => store.change((state) => {
        state.chosen = i;
      })
    });
    pick.checked = isChosen;
    const root = element(
        'div', {
          class: `slot${isChosen ? ' chosen' : ''}`,
          role: 'group',
          'aria-label': `Code ${i + 1}`,
          style: `--colour:${seriesColour(i)}`
        },
        element(
            'label', {
              class: 'pick',
              title: 'The scene uses this code; if there are four codes, a new one replaces it'
            },
            pick, `Code ${i + 1}${isChosen ? ', in the scene' : ''}`),
        element('div', {class: 'row'}, select, other),
        element(
            'div', {class: 'row'},
            element(
                'button', {type: 'button', id: `save-${i}`, onclick: () => this.#save(i)}, 'Save'),
            element(
                'button', {
                  type: 'button',
                  id: `remove-${i}`,
                  disabled: count === 1,
                  'aria-label': `Remove code ${i + 1}`,
                  onclick: () => store.change((state) => {
                    state.codes.splice(i, 1);
                    state.chosen = Math.min(
                        state.chosen > i ? state.chosen - 1 : state.chosen, state.codes.length - 1);
                  })
                },
                'Remove')),
        facts, problem);
    return {root, facts, problem, select};
  }

  async #save(i) {
    const code = this.lab.state.codes[i];
    try {
      const {file} = await this.lab.engine.call(
          'save_code', {camera: this.lab.camera.toml, code: askedCode(code)});
      saveText(
          file, code.file === undefined ? `${code.name}.code.json` : codeWord(code),
          'application/json');
    } catch (error) {
      showProblem(this.cards[i].problem, error.message);
    }
  }

  #describe(i) {
    const slot = this.lab.slots[i], card = this.cards[i];
    if (!card) return;
    showProblem(card.problem, slot.problem, card.select);
    const {code} = slot;
    card.facts.textContent = !code || slot.problem ? '' : [
      `${code.measurements} measurements`,
      code.exposures === undefined ? '' : `${code.exposures} exposures`, ...(code.notes ?? [])
    ].filter(Boolean).join(', ');
  }

  #draw(i) {
    const {code} = this.lab.slots[i], source = this.lab.state.codes[i];
    if (!code || !source) return;
    const kept = `${shortText(100 * code.curve_variance_kept, 3)} % of its variance shown`;
    this.waveforms.title(i, code.name, 'light above, gate below');
    this.correlation.title(i, code.name);
    this.curves.title(i, code.name, kept);
    this.waveforms.plots[i].show({
      label: `Waveforms of ${code.name}, ${code.measurements} measurements`,
      samples: code.light.shape[1],
      light: code.light,
      gates: code.gates,
      lightBehind: code.light_behind,
      gatesBehind: code.gates_behind,
      lightEdges: code.light_edges,
      gateEdges: code.gate_edges,
      move: (arm, measurement, edge, position) => {
        this.held ??=
            this.lab.state.codes[i];  // indices of edges must not change while one is dragged
        this.lab.moveEdge(i, this.held, {arm, measurement, edge, position});
      },
      settle: () => {
        this.held = null;
        this.lab.settle();
      },
    });
    this.correlation.plots[i].show(correlationSpec(code));
    this.#drawCurves();
  }

  #drawCurves() {
    const codes = this.lab.slots.slice(0, this.lab.state.codes.length).map((slot) => slot.code);
    const points = codes.map((code) => code && centred(code.curve));
    const radius = Math.max(1e-12, ...points.filter(Boolean).map(radiusOf));
    codes.forEach((code, i) => code && this.curves.plots[i].show({
      label: `Coding curve of ${code.name} in three directions`,
      view: this.view,
      points: points[i],
      colour: (n) => cssColour(sequentialColour(3 * n / points[i].length)),
      isCurve: true,
      radius,
      axes: axesOf(0.75 * radius)
    }));
  }
}
