// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Starts the lab.

import {CodesView} from './codes.js';
import {Commands} from './commands.js';
import {DesignView} from './design.js';
import {announce, byId, copyText, element, notice, saveText, showProblem} from '../../../viewer/dom.js';
import {Engine, missingFeature, packedEngine} from './engine.js';
import {ErrorsView} from './errors.js';
import {FieldPanel} from './fields.js';
import {Files} from './files.js';
import {fileName, Lab} from './lab.js';
import {shortText} from '../../../viewer/numbers.js';
import {SceneView} from './scene.js';
import {firstState, linkOf, stateOf, Store} from './store.js';
import {startTheme} from '../../../viewer/theme.js';

const patienceSeconds = 60;

function stop(text) {
  byId('bench').replaceChildren(element('p', {class: 'stop', role: 'alert'}, text));
  byId('bench').style.display = 'block';
}

function startCamera(lab, about) {
  const choice = byId('camera-choice'), {store} = lab;
  const panel = new FieldPanel(byId('fields'), {
    set: (key, text) => lab.set(
        key, text,
        (problem) => {
          panel.tell(key, problem ?? '');
          if (problem) announce(problem);
        }),
    reset: (key) => lab.reset(key),
    settle: () => lab.settle(),
  });
  choice.addEventListener('change', () => choice.value !== '!' && store.change((state) => {
    state.camera = {built_in: choice.value, changes: []};
  }));
  byId('save-camera')
      .addEventListener(
          'click',
          () => lab.camera && saveText(lab.camera.toml, cameraFileName(lab), 'application/toml'));
  lab.listen((what, problem) => {
    if (what === 'camera problem') showProblem(byId('camera-error'), problem);
    if (what !== 'camera') return;
    showProblem(byId('camera-error'), '');
    const {camera} = lab.state;
    choice.replaceChildren(
        ...(camera.file === undefined ? [] : [element('option', {value: '!'}, camera.file_name)]),
        ...about.cameras.map((name) => element('option', {value: name}, name)));
    choice.value = camera.file === undefined ? camera.built_in : '!';
    panel.show(lab.camera.fields, lab.firstFields);
    const f0 = lab.camera.fields.find((field) => field.key === 'fundamental_frequency_hz')?.value;
    byId('camera-summary').textContent =
        `${shortText(f0 / 1e6)} MHz, range ${shortText(299792458 / 2 / f0, 4)} m`;
  });
}

function cameraFileName(lab) {
  const {camera} = lab.state;
  if (camera.file !== undefined)
    return fileName(camera.file_name.replace(/\.toml$/i, '')) + '.toml';
  return `${fileName(camera.built_in)}${camera.changes.length ? '-changed' : ''}.toml`;
}

function startTools(lab) {
  const {store} = lab, undo = byId('undo'), redo = byId('redo');
  undo.addEventListener('click', () => store.undo());
  redo.addEventListener('click', () => store.redo());
  byId('fresh').addEventListener(
      'click', () => store.change((state) => Object.assign(state, firstState())));
  byId('link').addEventListener('click', async () => {
    const hash = await linkOf(store.state);
    if (!hash)
      return notice('This state is too large for a link. Save the camera and codes as files.');
    history.replaceState(null, '', hash);
    const isCopied = await copyText(location.href);
    byId('link').textContent = isCopied ? 'Copied' : 'In address bar';
    announce(
        isCopied ? 'Copied a link to this state.' :
                   'The address bar contains a link to this state.');
    setTimeout(() => {
      byId('link').textContent = 'Link';
    }, 1500);
  });
  addEventListener('keydown', (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase(), back = key === 'z' && !event.shiftKey;
    if (!back && key !== 'y' && !(key === 'z' && event.shiftKey)) return;
    const {target} = event;
    if (target.matches?.('input:not([type="range"], [type="checkbox"], [type="radio"])') &&
        target.value !== target.defaultValue && target.dataset.typing)
      return;
    event.preventDefault();
    if (back ? !store.canUndo : !store.canRedo)
      return announce(back ? 'Nothing to undo.' : 'Nothing to redo.');
    if (back)
      store.undo();
    else
      store.redo();
    announce(back ? 'Undone.' : 'Redone.');
  });
  // In text fields, Ctrl+Z undoes typing.
  addEventListener('input', (event) => {
    event.target.dataset.typing = 'yes';
  }, true);
  addEventListener('change', (event) => delete event.target.dataset.typing, true);
  const follow = () => {
    undo.disabled = !store.canUndo;
    redo.disabled = !store.canRedo;
  };
  store.listen(follow);
  follow();
}

function keepLink(store) {
  let timer = 0;
  store.listen(() => {
    clearTimeout(timer);
    timer = setTimeout(
        async () => history.replaceState(
            null, '', (await linkOf(store.state)) ?? location.pathname + location.search),
        400);
  });
}

function startLicences() {
  const licences = byId('licences');
  licences.addEventListener('toggle', () => {
    licences.querySelector('pre').textContent = byId('lab-licences')?.textContent ?? '';
  });
}

async function begin() {
  startTheme(byId('theme'));
  startLicences();
  if (matchMedia('(max-width: 56rem)').matches) byId('camera-fold').open = false;
  const missing = missingFeature();
  if (missing) return stop(missing);
  const {state, problem} = await stateOf(location.hash);
  const startWorker = await packedEngine();
  const cores = navigator.hardwareConcurrency || 2;
  const engine = new Engine(startWorker, Math.max(2, Math.min(4, cores)));
  const about = await Promise.race([
    engine.call('about', {}),
    new Promise(
        (_, reject) => setTimeout(
            () => reject(new Error('the engine does not respond')), 1000 * patienceSeconds))
  ]);
  const store = new Store(state ?? firstState()), lab = new Lab(store, engine);
  startCamera(lab, about);
  new CodesView(lab, about);
  new ErrorsView(lab);
  new SceneView(lab, about);
  const design = new DesignView(lab, startWorker);
  const commands = new Commands(lab, design.effort);
  design.effort.addEventListener('change', () => commands.follow());
  new Files(lab);
  startTools(lab);
  byId('about').textContent = `tofsmith ${about.version}.`;
  if (problem) notice(problem);
  keepLink(store);
  addEventListener('hashchange', async () => {
    const next = await stateOf(location.hash);
    if (next.problem) notice(next.problem);
    if (next.state) store.change((now) => Object.assign(now, next.state));
  });
  await lab.update();
  window.tofsmithLab = {store, lab, engine};  // for tests and the console
}

begin().catch((error) => stop(`The lab cannot start: ${error.message}`));
