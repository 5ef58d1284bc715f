// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Draws the figures of a report as they come into view.
(function () {
  'use strict';

  const status = window.tofsmithFigures = {total: 0, rendered: 0, errors: []};
  window.addEventListener('error', (event) => status.errors.push(String(event.message)));
  window.addEventListener('unhandledrejection', (event) => status.errors.push(String(event.reason)));

  const darkScheme = window.matchMedia('(prefers-color-scheme: dark)');
  let printing = false;
  const isDark = () => darkScheme.matches && !printing;

  // Fonts and colours of the page; the figures' JSON holds none.
  function template() {
    const colours = isDark()
      ? {ink: '#c9d1d9', grid: '#2a3038', spaceGrid: '#3d454f', line: '#6b7580', hover: '#22272e'}
      : {ink: '#3d444d', grid: '#e9ecef', spaceGrid: '#d4d9de', line: '#8a939d', hover: '#ffffff'};
    const axis = {
      automargin: true, color: colours.ink, exponentformat: 'power', gridcolor: colours.grid,
      linecolor: colours.line, showline: true, tickcolor: colours.line, ticklen: 4,
      ticks: 'outside', title: {font: {size: 12.5}, standoff: 8}, zeroline: false,
    };
    const spaceAxis = {
      backgroundcolor: 'rgba(0,0,0,0)', color: colours.ink, gridcolor: colours.spaceGrid,
      linecolor: colours.line, nticks: 5, showbackground: false, showspikes: false,
      tickfont: {size: 11}, title: {font: {size: 12}}, zeroline: false, zerolinecolor: colours.spaceGrid,
    };
    return {
      layout: {
        annotationdefaults: {font: {color: colours.ink, size: 12.5}},
        coloraxis: {colorbar: {
          outlinewidth: 0, thickness: 12, tickcolor: colours.line,
          ticklen: 4, ticks: 'outside',
          title: {font: {size: 12.5}}, x: 1.01, xpad: 6, ypad: 4}},
        font: {color: colours.ink, family: getComputedStyle(document.body).fontFamily, size: 12},
        hoverlabel: {bgcolor: colours.hover, bordercolor: colours.line, font: {color: colours.ink}},
        legend: {bgcolor: 'rgba(0,0,0,0)', orientation: 'h', x: 0, xanchor: 'left', y: 1.02, yanchor: 'bottom'},
        margin: {b: 48, l: 60, r: 16, t: 16},
        modebar: {activecolor: colours.ink, bgcolor: 'rgba(0,0,0,0)', color: colours.line},
        paper_bgcolor: 'rgba(0,0,0,0)',
        plot_bgcolor: 'rgba(0,0,0,0)',
        scene: {bgcolor: 'rgba(0,0,0,0)', xaxis: spaceAxis, yaxis: spaceAxis, zaxis: spaceAxis},
        xaxis: axis,
        yaxis: axis,
      },
    };
  }

  const textOf = (id) => document.getElementById(id).textContent;

  async function inflated(base64, format) {
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  // What src/report/packed_arrays.hpp packs, as a Float32Array or an array of rows of it.
  async function unpacked(array) {
    const planes = await inflated(array.data, 'deflate');
    const count = planes.length / array.bytes;
    const shape = array.shape.split(',').map(Number);
    const columns = shape.length < 2 ? count : shape[1];
    const words = new Uint32Array(count);
    const mask = 2 ** (8 * array.bytes);
    for (let i = 0; i < count; ++i) {
      let word = array.is_difference && i % columns > 0 ? words[i - 1] : 0;
      for (let b = 0; b < array.bytes; ++b) word += planes[b * count + i] * 2 ** (8 * b);
      words[i] = word % mask;
    }
    const values = array.step === undefined
      ? new Float32Array(words.buffer)
      : Float32Array.from(words, (word) => word === 0 ? NaN : (word - 1 + array.low) * array.step);
    if (shape.length < 2) return values;
    return Array.from({length: shape[0]}, (_, r) => values.subarray(r * columns, (r + 1) * columns));
  }

  // plotly.js and the arrays of all figures, before the first is drawn.
  let arrays = null;
  async function load() {
    if (typeof DecompressionStream === 'undefined')
      throw new Error('This browser cannot unpack the figures; those since 2023 can.');
    const library = document.createElement('script');
    library.textContent = new TextDecoder().decode(await inflated(textOf('plotly-js'), 'gzip'));
    document.head.append(library);
    arrays = await Promise.all(JSON.parse(textOf('packed-arrays')).map(unpacked));
  }

  // Puts in the arrays and turns black, which a dark page would swallow, into its ink.
  function decoded(json) {
    if (json === '#000000' && isDark()) return '#f0f3f6';
    if (json === null || typeof json !== 'object') return json;
    if (json.packed !== undefined) return arrays[json.packed];
    if (Array.isArray(json)) return json.map(decoded);
    return Object.fromEntries(Object.entries(json).map(([key, value]) => [key, decoded(value)]));
  }

  function size(plot) {
    const width = Math.max(plot.parentElement.clientWidth, Number(plot.dataset.minWidth));
    const height = Number(plot.dataset.fixed) + Number(plot.dataset.perWidth) * width;
    return {width: Math.round(width), height: Math.round(height)};
  }

  // A legend of several lines takes its height from the axes; the figure grows by it.
  function makeRoomForLegend(plot) {
    const legend = plot.querySelector('.legend .bg');
    const extra = legend ? legend.getBoundingClientRect().height - 32 : 0;
    if (extra > 0) return Plotly.relayout(plot, {height: size(plot).height + Math.round(extra)});
    return undefined;
  }

  // Pictures of which a slider shows one on its left and another on its right: traces whose meta
  // says {slider: 'left' or 'right', name: what the end of the slider is called}.
  const sliders = new Map();
  function slide(plot, data, layout) {
    const sliding = data.filter((trace) => trace.meta && trace.meta.slider);
    if (sliding.length === 0) return;
    if (!sliders.has(plot)) sliders.set(plot, addSlider(plot, sliding));
    const at = Number(sliders.get(plot).value);
    layout.shapes = [];
    for (const trace of sliding) {
      if (trace.meta.slider === 'left') {
        const x = trace.x0 + (at - 0.5) * trace.dx;
        layout.shapes.push({
          type: 'line', xref: trace.xaxis, yref: trace.yaxis, x0: x, x1: x,
          y0: trace.y0 - 0.5 * trace.dy, y1: trace.y0 + (trace.z.length - 0.5) * trace.dy,
          line: {color: '#ffffff', width: 2}});
        trace.z = trace.z.map((row) => row.subarray(0, at));
      } else {
        trace.x0 += at * trace.dx;
        trace.z = trace.z.map((row) => row.subarray(at));
      }
    }
  }
  function addSlider(plot, sliding) {
    const nameOf = (side) => sliding.find((trace) => trace.meta.slider === side).meta.name;
    const columns = sliding[0].z[0].length;
    const label = document.createElement('label');
    const input = document.createElement('input');
    label.className = 'slider';
    Object.assign(input, {type: 'range', min: 1, max: columns - 1, value: Math.round(columns / 2)});
    input.setAttribute('aria-label', `left of this column ${nameOf('left')}, right ${nameOf('right')}`);
    label.append(nameOf('left'), input, nameOf('right'));
    plot.parentElement.after(label);
    let drawing = false;
    let moved = false;
    const redraw = () => {
      moved = drawing;
      if (drawing) return;
      drawing = true;
      draw(plot).then(() => {
        drawing = false;
        if (moved) redraw();
      });
    };
    input.addEventListener('input', redraw);
    return input;
  }

  function draw(plot) {
    const id = plot.dataset.figure;
    const {data, layout} = decoded(JSON.parse(textOf('data-' + id)));
    slide(plot, data, layout);
    layout.uirevision = id;  // what is zoomed stays so
    const page = template();
    layout.margin = Object.assign({}, page.layout.margin, layout.margin);
    const config = {
      displaylogo: false, responsive: false,
      toImageButtonOptions: {filename: id, format: 'svg', scale: 1},
    };
    return Plotly.react(plot, data, Object.assign(layout, {template: page}, size(plot)), config)
      .then(() => makeRoomForLegend(plot));
  }

  // Each figure is drawn once, whoever asks first, and one after the other with a breath between,
  // so that the page stays alive.
  const plots = Array.from(document.querySelectorAll('.plot'));
  const drawings = new Map();
  let last = load().catch((error) => {
    status.errors.push(String(error));
    for (const plot of plots) plot.textContent = error.message;
    throw error;
  });
  function drawOnce(plot) {
    if (!drawings.has(plot)) {
      last = last.then(() => new Promise((resolve) => { setTimeout(resolve); }))
        .then(() => draw(plot))
        .then(() => { status.rendered += 1; },
              (error) => { status.errors.push(plot.dataset.figure + ': ' + error); });
      drawings.set(plot, last);
    }
    return drawings.get(plot);
  }

  status.total = plots.length;
  for (const plot of plots) plot.style.minHeight = size(plot).height + 'px';
  window.tofsmithRenderAll = () => Promise.all(plots.map(drawOnce));

  const drawVisible = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      drawVisible.unobserve(entry.target);
      drawOnce(entry.target);
    }
  }, {rootMargin: '600px 0px'});
  for (const plot of plots) drawVisible.observe(plot);

  function redraw() {
    for (const plot of drawings.keys()) draw(plot);
  }
  darkScheme.addEventListener('change', redraw);
  window.addEventListener('beforeprint', () => {
    printing = true;
    if (arrays) for (const plot of plots) draw(plot);  // now: the printer does not wait
  });
  window.addEventListener('afterprint', () => { printing = false; redraw(); });

  let lastWidth = window.innerWidth;
  let resizing = 0;
  window.addEventListener('resize', () => {
    clearTimeout(resizing);
    resizing = setTimeout(() => {
      if (window.innerWidth === lastWidth) return;
      lastWidth = window.innerWidth;
      for (const plot of plots) {
        plot.style.minHeight = size(plot).height + 'px';
        if (drawings.has(plot)) Plotly.relayout(plot, size(plot)).then(() => makeRoomForLegend(plot));
      }
    }, 150);
  });

  // The contents show where the reader is; on a narrow page they start folded.
  const links = new Map(Array.from(document.querySelectorAll('.contents a'),
                                   (link) => [link.hash.slice(1), link]));
  const details = document.querySelector('.contents details');
  const wide = window.matchMedia('(min-width: 78rem)');
  const fold = () => { details.open = wide.matches; };
  wide.addEventListener('change', fold);
  fold();
  for (const link of links.values()) link.addEventListener('click', fold);

  const sections = Array.from(document.querySelectorAll('section'));
  function markCurrent() {
    const above = sections.filter((s) => s.getBoundingClientRect().top < window.innerHeight / 3);
    const current = above.length > 0 ? above[above.length - 1] : sections[0];
    for (const [id, link] of links) link.classList.toggle('current', current && id === current.id);
  }
  window.addEventListener('scroll', markCurrent, {passive: true});
  markCurrent();
})();
