// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Draws the figures of a document: lines, maps, images, curves and point clouds.

import {inline} from './blocks.js';
import {colourBar, scaleOf} from './colour_bar.js';
import {cssColour} from './colours.js';
import {element, saveBlob, saveText} from './dom.js';
import {csvOf, pngOf, svgOf} from './export.js';
import {HeatMap} from './heat_map.js';
import {rangeOf, shortText} from './numbers.js';
import {Picture} from './picture.js';
import {legendOf, LinePlot, paddedRange} from './plot.js';
import {Space, SpaceView} from './space.js';

// Arrays of documents are plain lists, or packed by src/report/figure_json.cpp.

async function inflated(base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Decodes a list, with null for NaN, or a packed array {count, row, low, step, words}. */
async function unpacked(array) {
  if (Array.isArray(array)) return Float64Array.from(array, (value) => value ?? NaN);
  const {count, row, low, step} = array, planes = await inflated(array.words);
  const values = new Float32Array(count);
  for (let i = 0, word = 0; i < count; ++i) {
    if (i % row === 0) word = 0;
    word = (word + planes[i] + 256 * planes[count + i]) & 0xffff;
    values[i] = word === 0 ? NaN : (word - 1 + low) * step;
  }
  return values;
}

// Palette of documents. The theme replaces each colour by a light or dark shade.
const palette = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#000000'];
const referenceColour = '#8a8f98';
const dashes = {
  solid: '',
  dash: '7 4',
  dot: '2 3',
  dash_dot: '8 3 2 3'
};

function cssOf(colour) {
  const place = palette.indexOf(colour);
  if (place >= 0) return `var(--s${place})`;
  return colour === referenceColour ? 'var(--line)' : colour;
}

const titleOf = ({label, unit}) => (unit ? `${label} (${unit})` : label);

/** Converts an axis of a document for a plot of these values. */
function axisSpec(axis, values) {
  let range = axis.range;
  if (!range) {
    const [low, high] = rangeOf(values, axis.log);
    range = paddedRange(axis.from_zero ? [Math.min(0, low), Math.max(0, high)] : [low, high], axis.log);
    if (axis.from_zero && low >= 0) range[0] = 0;
  }
  return {
    title: titleOf(axis),
    range,
    log: axis.log,
    unit: axis.unit,
    isWhole: values.every((list) => list.every(Number.isInteger))
  };
}

/** Returns the x values of a series: a list, or equidistant values {count, from, to}. */
const placesIn = (x) => (Array.isArray(x) ?
    x :
    Array.from({length: x.count}, (_, i) => x.from + i * (x.to - x.from) / (x.count - 1)));

const seriesSpec = (one) => ({
  name: one.name,
  x: placesIn(one.x),
  y: one.y.map((value) => value ?? NaN),
  error: one.error,
  mark: one.mark,
  colour: cssOf(one.colour),
  dash: dashes[one.dash],
  width: one.width
});

/** Returns an x axis whose range equals the range of the data, without padding. */
function tightRange(axis, values) {
  if (axis.range) return axis;
  const [low, high] = rangeOf(values, axis.log);
  return low < high && !axis.log ? {...axis, range: [low, high]} : axis;
}

const axisHeight = 32;  // of the ticks and title below the last row of a grid

function drawLines(block, body) {
  const {columns, rows} = block, isGrid = rows.length > 1 || columns.length > 1;
  const all = rows.map((row) => row.panels.map((panel) => panel.map(seriesSpec)));
  const named = all.flat(2).filter((one) => one.name);
  if (new Set(named.map((one) => one.name)).size > 1) body.append(legendOf(named));
  const grid = element(
      'div', {class: `panels${rows.length > 1 ? ' rows' : ''}`, style: `--columns:${columns.length}`});
  body.append(grid);
  const axes = columns.map((column, c) => {
    const series = all.flatMap((row) => row[c]);
    const heights = series.flatMap(
        (one) => one.error ?
            [one.y, one.y.map((v, i) => v + one.error[i]), one.y.map((v, i) => v - one.error[i])] :
            [one.y]);
    const places = series.map((one) => one.x);
    const isDots = series.some((one) => /markers/.test(one.mark));
    return {
      x: axisSpec(isDots ? column.x : tightRange(column.x, places), places),
      y: axisSpec(column.y, heights)
    };
  });
  const isFront = Boolean(body.closest('.front'));  // the first screen has little space
  const rowHeight = Math.max(isFront ? 33 : 42, Math.min(84, (isFront ? 200 : 320) / rows.length));
  rows.forEach((row, r) => columns.forEach((column, c) => {
    const plot = new LinePlot(), {x, y} = axes[c], isLast = r === rows.length - 1;
    const title = r === 0 && column.title ?
        [element('p', {class: 'panel-title'}, column.title, y.title && rows.length > 1 ? element('small', {}, y.title) : '')] : [];
    if (c === 0 && rows.length > 1)
      grid.append(element(
          'p', {class: 'row-title', style: `height:${rowHeight}px;margin-bottom:${isLast ? axisHeight : 0}px`},
          row.title));
    grid.append(element('div', {class: 'panel'}, ...title, plot.root));
    plot.show({
      label: [block.alt, column.title, row.title].filter(Boolean).join(', '),
      height: rows.length > 1 ? rowHeight + (isLast ? axisHeight : 0) : isFront ? 205 : isGrid ? 240 : 290,
      x,
      y: rows.length > 1 ? {...y, title: ''} : y,
      series: all[r][c],
      hasLegend: false,
      isCompact: rows.length > 1,
      isBare: !isLast
    });
  }));
  return () => [
    ['row', 'column', 'series', ...(isGrid ? ['x', 'y'] : [axes[0].x.title, axes[0].y.title]), 'error'],
    ...rows.flatMap((row, r) => columns.flatMap(
        (column, c) => all[r][c].flatMap((one) => Array.from(
            one.x, (x, i) => [row.title, column.title, one.name, x, one.y[i], one.error?.[i]]))))
  ];
}

// Text of a value in a map cell.
const cellText = (value) => (Math.abs(value) >= 1e4 ? value.toExponential(1) : shortText(value, 3));

function panelGrid(columns, count) {
  const most = count === 4 && columns === 3 ? 2 : Math.min(columns, count);  // no single panel
  return element('div', {class: 'panels titled', style: `--columns:${most}`});
}

function drawMap({alt, columns, show_values, x, y, colours, panels}, body) {
  const values = panels.map((panel) => panel.values.map((value) => value ?? NaN));
  const scale = scaleOf(colours, values), grid = panelGrid(columns, panels.length);
  body.append(grid, colourBar(scale.bar));
  panels.forEach((panel, p) => {
    const plot = new HeatMap();
    grid.append(element('div', {class: 'panel'}, element('p', {class: 'panel-title'}, panel.title), plot.root));
    plot.show({
      label: `${alt}, ${panel.title}`,
      columns: x.ticks,
      rows: y.ticks,
      values: values[p],
      height: Math.max(150, 60 + 27 * y.ticks.length),
      colour: scale.colour,
      cellText: show_values ? cellText : () => '',
      titles: {x: titleOf(x), y: titleOf(y)},
      details: (c, r) => [
        `${x.label} ${x.ticks[c]} ${x.unit}`, `${y.label} ${y.ticks[r]} ${y.unit}`,
        scale.text(values[p][r * x.ticks.length + c])
      ]
    });
  });
  return () => [
    ['panel', titleOf(x), titleOf(y), titleOf(colours)],
    ...panels.flatMap(({title}, p) => values[p].map(
        (value, i) => [title, x.ticks[i % x.ticks.length], y.ticks[Math.floor(i / x.ticks.length)], value]))
  ];
}

/** Returns planes [{values, before}] of an image figure and, with a reference, differences. */
async function planesOf({panels, reference}) {
  const planes = await Promise.all(panels.map(async (panel) => ({
    values: await unpacked(panel.values),
    before: panel.before && await unpacked(panel.before)
  })));
  if (!reference) return {planes};
  const {period, factor} = reference, truth = await unpacked(reference.values);
  const minus = (values) => values && values.map((value, i) => {
    const difference = value - truth[i];
    return factor * (difference - (period ? period * Math.round(difference / period) : 0));
  });
  const differences =
      planes.map(({values, before}) => ({values: minus(values), before: minus(before)}));
  return {planes, differences};
}

async function drawImages(block, body) {
  const {alt, columns, width, height, pixel_step: step, panels, reference} = block;
  const {planes, differences} = await planesOf(block);
  const grid = panelGrid(columns, panels.length), bar = element('div');
  const pictures = panels.map(() => new Picture());
  grid.append(...pictures.map((picture) => element('div', {class: 'panel'}, picture.root)));
  const show = (shown, colours) => {
    const scale = scaleOf(colours, shown.flatMap(
        ({values, before}) => (before ? [values, before] : [values])));
    pictures.forEach((picture, p) => picture.show({
      label: `${alt}, ${panels[p].title}`,
      title: panels[p].title,
      width,
      height,
      ...shown[p],
      colour: scale.colour,
      text: (value) => `${colours.label} ${scale.text(value)}`
    }));
    bar.replaceChildren(colourBar(scale.bar));
  };
  if (differences)
    body.append(choiceOf([[block.colours.label, () => show(planes, block.colours)],
                          [reference.name, () => show(differences, reference.colours)]]));
  body.append(grid);
  const slid = pictures.filter((_, p) => planes[p].before);
  if (slid.length) body.append(sliderOf(block, slid));
  body.append(bar);
  show(planes, block.colours);
  return () => [
    ['panel', 'row', 'column', titleOf(block.colours), ...(slid.length ? [block.before_name] : [])],
    ...panels.flatMap(({title}, p) => Array.from(
        planes[p].values, (value, i) => [title, step * Math.floor(i / width), step * (i % width),
                                         value, ...(slid.length ? [planes[p].before?.[i]] : [])]))
  ];
}

/** Returns buttons of which one is selected: [[name, action], ...]. */
function choiceOf(choices) {
  const buttons = choices.map(([name, act]) => element('button', {
                                type: 'button',
                                onclick: ({target}) => {
                                  act();
                                  for (const one of buttons)
                                    one.setAttribute('aria-pressed', String(one === target));
                                }
                              }, name));
  buttons.forEach((one, i) => one.setAttribute('aria-pressed', String(i === 0)));
  return element('div', {class: 'choice', role: 'group', 'aria-label': 'Values to show'}, ...buttons);
}

/** Returns a slider for the border between the `before` and `after` images. */
function sliderOf({before_name: left, after_name: right}, pictures) {
  const input = element('input', {
    type: 'range',
    min: 0,
    max: 1000,
    value: 500,
    'aria-label': `Border between ${left} and ${right}`,
    oninput: () => {
      for (const picture of pictures) picture.split(Number(input.value) / 1000);
    }
  });
  for (const picture of pictures)
    picture.node.addEventListener('pointerdown', (event) => {
      const move = ({clientX}) => {
        const box = picture.node.getBoundingClientRect();
        input.value = 1000 * (clientX - box.left) / box.width;
        input.dispatchEvent(new Event('input'));
      };
      const stop = new AbortController();
      addEventListener('pointermove', move, {signal: stop.signal});
      for (const end of ['pointerup', 'pointercancel'])
        addEventListener(end, () => stop.abort(), {signal: stop.signal});
      move(event);
    });
  return element('label', {class: 'slider'}, element('span', {}, left), input, element('span', {}, right));
}

const middle = ([low, high]) => (low + high) / 2;

/** Centres the points of all panels together. Returns {points: arrays of (N, 3), ranges}. */
function centred(places) {
  const ranges = [0, 1, 2].map((axis) => rangeOf(places.map((one) => one[axis])));
  const centre = ranges.map(middle);
  const points = places.map(([x, y, z]) => {
    const all = new Float32Array(3 * x.length);
    x.forEach((_, i) => all.set([x[i] - centre[0], y[i] - centre[1], z[i] - centre[2]], 3 * i));
    return all;
  });
  return {points, ranges: ranges.map(([low, high], i) => [low - centre[i], high - centre[i]])};
}

const placesOf = (panels) => Promise.all(
    panels.map((panel) => Promise.all([panel.x, panel.y, panel.z].map(unpacked))));

function drawSpaces({alt, colours, panels}, body, values, spec) {
  const scale = scaleOf(colours, values), grid = panelGrid(3, panels.length);
  body.append(grid, colourBar(scale.bar));
  panels.forEach((panel, p) => {
    const space = new Space();
    const shades = Array.from(values[p], (value) => cssColour(scale.colour(value) ?? [128, 128, 128]));
    grid.append(element(
        'div', {class: 'panel'}, element('p', {class: 'panel-title'}, panel.title), space.root));
    space.show({...spec, label: `${alt}, ${panel.title}`, points: spec.points[p], colour: (i) => shades[i]});
  });
}

const rowsOf = (panels, places, values, header) => () => [
  ['panel', 'x', 'y', 'z', header],
  ...panels.flatMap(({title}, p) => Array.from(
      values[p], (value, i) => [title, ...places[p].map((axis) => axis[i]), value]))
];

async function drawCurves(block, body) {
  const {panels, axes} = block, places = await placesOf(panels);
  const values = await Promise.all(panels.map((panel) => unpacked(panel.values)));
  const {points, ranges} = centred(places);
  drawSpaces(block, body, values, {
    view: new SpaceView(),
    points,
    radius: Math.hypot(...ranges.map(([, high]) => high)) || 1,
    isCurve: true,
    axes: axes.map((axis, i) => ({
                     title: titleOf(axis),
                     from: [0, 1, 2].map((j) => (i === j ? ranges[i][0] : 0)),
                     to: [0, 1, 2].map((j) => (i === j ? ranges[i][1] : 0))
                   }))
  });
  return rowsOf(panels, places, values, titleOf(block.colours));
}

// Point clouds are in camera coordinates: x right, y down, z forward. Drawings have z up.
async function drawClouds(block, body) {
  const {panels} = block, places = await placesOf(panels);
  const values = await Promise.all(panels.map((panel) => unpacked(panel.values)));
  const turned = places.map(([x, y, z]) => [x, z, y.map((value) => -value)]);
  const {points, ranges} = centred(turned);
  const lengths = ranges.map(([low, high]) => shortText(high - low, 3));
  const corner = [ranges[0][0], ranges[1][0], ranges[2][0]];
  drawSpaces(block, body, values, {
    view: new SpaceView({yaw: 0.35, pitch: 0.35}),
    points,
    box: ranges.map(([, high]) => Math.max(high, 1e-6)),
    isCurve: false,
    height: 380,
    pointSize: block.point_size_px,
    axes: ['x', 'z', 'y'].map((name, i) => ({
                                title: `${name}: ${lengths[i]} m`,
                                from: corner,
                                to: corner.map((value, j) => (i === j ? ranges[i][1] : value))
                              }))
  });
  return rowsOf(panels, places, values, titleOf(block.colours));
}

/** Functions that draw a figure into an element and return a function for its CSV rows. */
export const kinds = {
  lines: drawLines,
  map: drawMap,
  image: drawImages,
  curves: drawCurves,
  cloud: drawClouds
};

/** Returns {node, draw}: the element of a figure, and the asynchronous function that draws it. */
export function figureBlock(block) {
  const body = element('div', {class: 'body'});
  const caption = element('p', {class: 'caption'}, ...inline(block.caption));
  const shot = element('div', {class: 'shot'}, element('h3', {}, block.title), body);
  const buttons = element('div', {class: 'save'});
  const node = element(
      'figure', {id: block.id, class: `figure block block-${block.kind}`, 'data-figure': block.id},
      buttons, shot, block.caption ? caption : null);
  const draw = async () => {
    const rows = await kinds[block.kind](block, body);
    const save = (name, write) => element('button', {type: 'button', onclick: write, 'aria-label': `Save ${block.title} as ${name}`}, name);
    buttons.append(
        save('SVG', () => saveText(svgOf(shot), `${block.id}.svg`, 'image/svg+xml')),
        save('PNG', async () => saveBlob(await pngOf(shot), `${block.id}.png`)),
        save('CSV', () => saveText(csvOf(rows()), `${block.id}.csv`, 'text/csv')));
  };
  return {node, draw};
}
