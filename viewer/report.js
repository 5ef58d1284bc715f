// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Renders a page from its document. Figures are drawn when they scroll into view.

import {blockOf} from './blocks.js';
import {byId, element} from './dom.js';
import {figureBlock, kinds} from './figures.js';
import {startTheme} from './theme.js';

const status = window.tofsmithFigures = {total: 0, rendered: 0, errors: []};
addEventListener('error', (event) => status.errors.push(String(event.message)));
addEventListener('unhandledrejection', (event) => status.errors.push(String(event.reason)));

const drawings = new Map();  // functions that draw each figure once, by node

function nodeOf(block) {
  if (!(block.kind in kinds)) return blockOf(block);
  const {node, draw} = figureBlock(block);
  let drawing = null;
  drawings.set(node, () => drawing ??= draw().then(() => {
    status.rendered += 1;
  }, (error) => {
    status.errors.push(`${block.id}: ${error}`);
    node.append(element('p', {class: 'problem'}, `This figure cannot be drawn: ${error.message}`));
  }));
  return node;
}

function sectionOf({title, layout, blocks}, i) {
  const nodes = blocks.map(nodeOf), id = `section-${i + 1}`;
  if (layout === 'front')
    return element('section', {id, class: 'front', 'aria-label': title}, ...nodes);
  return element(
      'details', {id, class: 'section', open: layout === 'open'},
      element('summary', {}, element('h2', {}, title)), ...nodes);
}

function show({title, subtitle, footer, sections}) {
  const theme = element('button', {type: 'button', class: 'theme'});
  const header = element(
      'header', {},
      element(
          'div', {}, element('h1', {}, title),
          subtitle ? element('p', {class: 'subtitle'}, subtitle) : null),
      theme);
  byId('page').append(
      title ? header : '',  // pages of a single figure have no title
      element('main', {}, ...sections.map(sectionOf)),
      footer ? element('footer', {}, footer) : '');
  startTheme(theme);
}

show(JSON.parse(byId('document').textContent));
status.total = drawings.size;

const drawVisible = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    drawVisible.unobserve(entry.target);
    drawings.get(entry.target)();
  }
}, {rootMargin: '600px 0px'});
for (const node of drawings.keys()) drawVisible.observe(node);

function unfold() {
  for (const section of document.querySelectorAll('details.section')) section.open = true;
}

window.tofsmithRenderAll = () => {
  unfold();
  return Promise.all([...drawings.values()].map((draw) => draw()));
};
addEventListener('beforeprint', unfold);

// A link to a figure opens the section that contains it.
function reveal() {
  const target = location.hash.length > 1 ? byId(location.hash.slice(1)) : null;
  const section = target?.closest('details.section');
  if (!section) return;
  section.open = true;
  target.scrollIntoView();
}
addEventListener('hashchange', reveal);
reveal();
