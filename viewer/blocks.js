// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Blocks of a page other than figures: text, settings, tables, commands.

import {copyText, element, saveText} from './dom.js';
import {csvOf} from './export.js';

/** Converts text with `code` in backticks to nodes. */
export const inline = (text) => text.split(/`([^`]+)`/).map(
    (part, i) => (i % 2 ? element('code', {}, part) : part));

const pairs = (name) => ({entries}) => element(
    'dl', {class: name},
    ...entries.map(
        ([key, value]) => element(
            'div', {}, element('dt', {}, key), element('dd', {}, value))));

const unbrokenLetters = 40;  // longer cells are sentences, which may wrap

function tableOf({id, title, caption, columns, rows, highlighted}) {
  const cell = (tag, c, ...content) => element(tag, {
    class: columns[c].numeric ? 'number' : rows.some((row) => row[c].length > unbrokenLetters) ? 'long' : null,
    scope: tag === 'th' ? 'row' : null
  }, ...content);
  const save = element('button', {
    type: 'button',
    onclick: () => saveText(
        csvOf([columns.map((column) => column.header), ...rows]), `${id || 'table'}.csv`, 'text/csv')
  }, 'CSV');
  const text = element('p', {class: 'caption'}, ...inline(caption));
  return element(
      'div', {class: 'table-block', id: id || null},
      element(
          'div', {class: 'block-head'}, title ? element('h3', {}, title) : text,
          element('div', {class: 'save'}, save)),
      element(
          'div', {class: 'table', tabindex: 0, role: 'region', 'aria-label': 'Table'},
          element(
              'table', {},
              element(
                  'thead', {},
                  element(
                      'tr', {},
                      ...columns.map(({header, numeric}) => element('th', {
                                       scope: 'col',
                                       class: numeric ? 'number' : null
                                     }, ...inline(header))))),
              element(
                  'tbody', {},
                  ...rows.map((row, r) => element(
                                  'tr', {class: r === highlighted ? 'highlighted' : null},
                                  ...row.map((one, c) => cell(c ? 'td' : 'th', c, one))))))),
      title ? text : null);
}

function codeOf({text}) {
  const copy = element('button', {
    type: 'button',
    onclick: async () => {
      copy.textContent = await copyText(text) ? 'Copied' : 'Cannot copy';
    }
  }, 'Copy');
  return element(
      'div', {class: 'code'}, element('pre', {}, element('code', {}, text)), copy);
}

const makers = {
  text: ({text}) => element('p', {}, ...inline(text)),
  settings: pairs('settings'),
  numbers: pairs('numbers'),
  table: tableOf,
  code: codeOf
};

/** Returns the element of a block other than a figure. */
export function blockOf(block) {
  if (!(block.kind in makers)) throw new Error(`unknown kind of block: ${block.kind}`);
  const node = makers[block.kind](block);
  node.classList.add('block', `block-${block.kind}`);
  return node;
}
