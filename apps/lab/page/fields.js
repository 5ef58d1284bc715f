// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Camera form: one control per key, generated from the engine's description of the key.

import {element, showProblem} from '../../../viewer/dom.js';
import {fieldText} from '../../../viewer/numbers.js';

const sectionTitles = {
  '': 'Camera',
  light: 'Light',
  sensor: 'Sensor',
  operating: 'Light levels',
  optics: 'Optics',
  lens: 'Lens',
  playback: 'Playback',
  temperature: 'Temperature',
  camera: 'Camera'
};
const groupOf = (section) => (section ?? '').split('.')[0];
const titleOf = (section) =>
    sectionTitles[section] ?? section.replaceAll('_', ' ').replace(/^./, (c) => c.toUpperCase());
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const steps = 1000;

/** Converts a value of a field to a position of its slider, and back. */
function sliderScale(field) {
  let [low, high] = field.usual;
  if (Number.isFinite(field.value))
    [low, high] = [Math.min(low, field.value), Math.max(high, field.value)];
  const log = field.log && low > 0;
  const rounded = (value) =>
      (field.type === 'integer' ? Math.round(value) : Number(value.toPrecision(3)));
  return {
    place: (v) => Math.round(
        steps * (log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low))),
    value: (p) =>
        (p === 0 ?
             low :
             p === steps ?
             high :
             rounded(log ? low * (high / low) ** (p / steps) : low + (high - low) * p / steps)),
    step: field.type === 'integer' && !log ? Math.max(1, Math.floor(steps / (high - low))) : 1,
  };
}

/** One key of the camera. */
class Field {
  constructor(field, panel) {
    this.key = field.key;
    this.panel = panel;
    const id = `field-${field.key.replaceAll('.', '-')}`;
    this.problem =
        element('p', {class: 'problem', id: `${id}-problem`, role: 'alert', hidden: true});
    this.back = element(
        'button', {
          type: 'button',
          class: 'back',
          hidden: true,
          'aria-label': `Reset ${field.label}`,
          title: 'Reset',
          onclick: () => panel.reset(this.key)
        },
        '\u21ba');
    this.doc = element('p', {class: 'doc', id: `${id}-doc`, title: field.doc}, field.doc);
    const described = `${id}-doc ${id}-problem`;
    this.inputs = this.#inputs(field, id, described);
    const label = field.type === 'boolean' ? element('span', {style: 'flex:1'}) :
                                             element('label', {'for': id}, field.label);
    const name = field.type === 'boolean' ?
        null :
        element(
            'div', {class: 'name', title: field.key}, label,
            element('span', {class: 'unit'}, field.unit ?? ''), this.back);
    this.root = element(
        'div', {class: 'field', 'data-key': field.key}, name, this.inputs, this.doc, this.problem);
    if (field.type === 'boolean') this.inputs.append(this.back);
  }

  #inputs(field, id, described) {
    if (field.type === 'boolean') {
      this.input = element('input', {
        type: 'checkbox',
        id,
        'aria-describedby': described,
        onchange: () => this.#commit(String(this.input.checked))
      });
      return element(
          'div', {class: 'check', title: field.key}, this.input,
          element('label', {'for': id, style: 'flex:1'}, field.label));
    }
    if (field.type === 'choice') {
      this.input = element(
          'select',
          {id, 'aria-describedby': described, onchange: () => this.#commit(this.input.value)},
          ...field.choices.map((choice) => element('option', {value: choice}, choice)));
      return element('div', {class: 'inputs wide'}, this.input);
    }
    const isNumber = field.type === 'number' || field.type === 'integer';
    this.input = element('input', {
      type: 'text',
      id,
      'aria-describedby': described,
      spellcheck: 'false',
      placeholder: 'not set',
      inputmode: isNumber ? 'text' : null,
      onchange: () => this.#typed(),
      oninput: () => {
        if (this.problem.hidden === false && this.input.value === this.shown) this.tell('');
      }
    });
    if (!isNumber || !field.usual) return element('div', {class: 'inputs wide'}, this.input);
    this.slider = element('input', {
      type: 'range',
      min: 0,
      max: steps,
      'aria-label': `${field.label}${field.unit ? ', ' + field.unit : ''}`,
      oninput: () => this.#slid(),
      onchange: () => this.panel.settle()
    });
    return element('div', {class: 'inputs'}, this.slider, this.input);
  }

  #typed() {
    if (this.input.value === this.shown) return this.tell('');
    this.#commit(this.input.value.trim());
    this.panel.settle();
  }

  #slid() {
    const value = this.scale.value(Number(this.slider.value));
    this.input.value = fieldText(value);
    this.slider.setAttribute('aria-valuetext', `${fieldText(value)} ${this.field.unit ?? ''}`);
    this.#commit(fieldText(value));
  }

  #commit(text) {
    this.asked = text;
    this.panel.set(this.key, text);
  }

  /** Shows the error of the input; empty: valid. */
  tell(message) {
    showProblem(this.problem, message, this.input);
  }

  /** Updates the control after a change of the camera. */
  update(field, first) {
    const isUnder = document.activeElement === this.slider && this.slider;
    this.field = field;
    if (this.slider) {
      if (!isUnder) this.scale = sliderScale(field);
      this.scale ??= sliderScale(field);
      this.slider.step = this.scale.step;
      if (!isUnder || this.input.value !== fieldText(field.value))
        this.slider.value = Number.isFinite(field.value) ? this.scale.place(field.value) : 0;
      this.slider.setAttribute(
          'aria-valuetext',
          field.value === null ? 'not set' : `${fieldText(field.value)} ${field.unit ?? ''}`);
    }
    const text = fieldText(field.value),
          isRefused = !this.problem.hidden && text === this.refusedAt;
    if (field.type === 'boolean')
      this.input.checked = field.value === true;
    else if (!isRefused)
      this.input.value = text;
    this.shown = text;
    if (!isRefused) this.tell('');
    const isChanged = first !== undefined && !same(first.value, field.value);
    this.root.classList.toggle('changed', isChanged);
    this.back.hidden = !isChanged;
  }
}

/** All fields of the camera. */
export class FieldPanel {
  #controls = new Map();
  #shape = '';

  /** @param form  parent element; @param actions  set(key, text), reset(key), settle() */
  constructor(form, actions) {
    this.form = form;
    Object.assign(this, actions);
    form.addEventListener('submit', (event) => event.preventDefault());
  }

  /** Shows the fields of a camera; `first` are those of the unmodified camera. */
  show(fields, first) {
    const shape = JSON.stringify(fields.map(({key, type, choices}) => [key, type, choices]));
    if (shape !== this.#shape) this.#build(fields);
    this.#shape = shape;
    const before = new Map(first.map((field) => [field.key, field]));
    for (const field of fields) this.#controls.get(field.key).update(field, before.get(field.key));
  }

  /** Shows an error at a field; returns false if the field does not exist. */
  tell(key, message) {
    const control = this.#controls.get(key);
    if (!control) return false;
    control.refusedAt = control.shown;
    control.tell(message);
    return true;
  }

  #build(fields) {
    const focus = document.activeElement?.id,
          open = new Set(
              [...this.form.querySelectorAll('details[open]')].map((d) => d.dataset.section));
    this.#controls = new Map(fields.map((field) => [field.key, new Field(field, this)]));
    const sections = [...new Set(fields.map((field) => groupOf(field.section)))];
    this.form.replaceChildren(...sections.map((section) => {
      const own = fields.filter((field) => groupOf(field.section) === section);
      const nodes = (isExpert) => own.filter((field) => Boolean(field.expert) === isExpert)
                                      .map((field) => this.#controls.get(field.key).root);
      const experts = nodes(true), usual = nodes(false);
      const fold = experts.length ?
          element(
              'details', {class: 'experts', 'data-section': section, open: open.has(section)},
              element(
                  'summary', {},
                  usual.length ? `${experts.length} more (advanced)` :
                                 `${experts.length} keys (advanced)`),
              ...experts) :
                                 null;
      return element(
          'fieldset', {class: 'group'}, element('legend', {}, titleOf(section)),
          element('div', {}, ...usual, fold));
    }));
    if (focus) document.getElementById(focus)?.focus({preventScroll: true});
  }
}
