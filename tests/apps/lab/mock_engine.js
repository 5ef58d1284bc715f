// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// A stand-in for the engine that answers the lab's calls with plausible data, so that the page can
// be tested where no WebAssembly is built. It simulates nothing.
'use strict';

const mockCameras = {
  'paper-10f0': {peak: 15, taps: 1, f0: 15e6, kind: 'hann'},
  'kinect-v2': {peak: 2, taps: 2, f0: 8e6, kind: 'none'},
  'paper-30x': {peak: 30, taps: 1, f0: 15e6, kind: 'none'},
};
const mockFamilies = [
  'sinusoid-k3', 'sinusoid-k4', 'square-k4', 'hamiltonian-k3', 'hamiltonian-k4', 'hamiltonian-k5'
];
const numberField = (key, section, unit, doc, value, low, usual, more = {}) => ({
  key,
  section,
  unit,
  doc,
  type: 'number',
  value,
  default: value,
  low,
  usual,
  log: false,
  expert: false,
  ...more
});

function mockFields(c) {
  return [
    {
      key: 'name',
      section: '',
      unit: '',
      doc: 'what the camera is called',
      type: 'text',
      value: c.name,
      default: '',
      expert: true
    },
    numberField(
        'fundamental_frequency_hz', '', 'Hz', 'everything repeats after c / (2 f0)', c.f0, 1e3,
        [1e6, 1e8], {log: true}),
    numberField(
        'exposure_s', '', 's', 'of all exposures together', c.exposure, 0, [1e-3, 1], {log: true}),
    {
      ...numberField('samples', '', '', 'samples per period', c.samples, 8, [60, 720]),
      type: 'integer'
    },
    numberField('light.peak_factor', 'light', '', 'peak over average power', c.peak, 1, [1, 30]),
    {
      key: 'light.binary',
      section: 'light',
      unit: '',
      doc: 'switches on and off only',
      type: 'boolean',
      value: c.binary,
      default: true,
      expert: false
    },
    {
      key: 'light.impulse_response.kind',
      section: 'light.impulse_response',
      unit: '',
      doc: 'of the light source',
      type: 'choice',
      choices: ['none', 'hann', 'gaussian', 'lowpass'],
      value: c.kind,
      default: 'none',
      expert: false
    },
    ...(c.kind === 'none' ? [] :
                            [numberField(
                                'light.impulse_response.f_max_hz', 'light.impulse_response', 'Hz',
                                'nothing above it', c.fmax, 1e6, [1e7, 1e9], {log: true})]),
    numberField(
        'light.edge_jitter_s', 'light', 's', 'rms, of the edges', 0, 0, [0, 1e-9], {expert: true}),
    {
      ...numberField('sensor.taps', 'sensor', '', 'buckets of a pixel', c.taps, 1, [1, 4]),
      type: 'integer',
      high: 8
    },
    numberField('sensor.read_noise_e', 'sensor', 'e', 'rms, per reading', c.read, 0, [0, 100]),
    {
      key: 'sensor.noise',
      section: 'sensor',
      unit: '',
      doc: 'distribution',
      type: 'choice',
      choices: ['poisson', 'gaussian'],
      value: c.noise,
      default: 'poisson',
      expert: false
    },
    numberField(
        'sensor.modulation_contrast', 'sensor', '', 'below 1 the taps mix', c.contrast, 0, [0.1, 1],
        {high: 1}),
    {
      ...numberField(
          'sensor.full_well_e', 'sensor', 'e', 'clips', null, 0, [1e3, 1e6],
          {log: true, expert: true}),
      value: null,
      default: null
    },
    {
      key: 'operating.signal_e_per_s',
      section: 'operating',
      unit: 'e/s',
      doc: 'signal levels',
      type: 'list',
      value: c.signal,
      default: c.signal,
      expert: false
    },
    {
      key: 'operating.ambient_e_per_s',
      section: 'operating',
      unit: 'e/s',
      doc: 'ambient levels',
      type: 'list',
      value: c.ambient,
      default: c.ambient,
      expert: false
    },
    {
      key: 'operating.error',
      section: 'operating',
      unit: '',
      doc: 'kind of depth error',
      type: 'choice',
      choices: ['linear', 'circular'],
      value: c.error,
      default: 'linear',
      expert: false
    },
  ];
}
const mockMembers = {
  fundamental_frequency_hz: 'f0',
  exposure_s: 'exposure',
  samples: 'samples',
  name: 'name',
  'light.peak_factor': 'peak',
  'light.binary': 'binary',
  'light.impulse_response.kind': 'kind',
  'light.impulse_response.f_max_hz': 'fmax',
  'sensor.taps': 'taps',
  'sensor.read_noise_e': 'read',
  'sensor.noise': 'noise',
  'sensor.modulation_contrast': 'contrast',
  'operating.signal_e_per_s': 'signal',
  'operating.ambient_e_per_s': 'ambient',
  'operating.error': 'error'
};

class MockError extends Error {
  constructor(message, field) {
    super(message);
    this.field = field;
  }
}

function builtIn(name) {
  const known = mockCameras[name];
  if (!known) throw new MockError(`no built-in camera is called '${name}'`);
  return {
    name,
    exposure: 0.3,
    samples: 240,
    fmax: 10 * known.f0,
    read: 20,
    noise: 'gaussian',
    contrast: 1,
    signal: [1e3, 3162.27766, 1e4, 31622.7766, 1e5],
    ambient: [1e2, 1e3, 1e4, 31622.7766, 1e5],
    error: 'linear',
    binary: true,
    ...known
  };
}

function parsed(toml) {
  if (toml.startsWith('# mock ')) return JSON.parse(toml.slice(7));
  const frequency = /^fundamental_frequency_hz\s*=\s*(\S+)/m.exec(toml);
  if (!frequency) throw new MockError('mine.toml:1:1: expected fundamental_frequency_hz');
  return {...builtIn('paper-10f0'), name: 'dropped', f0: Number(frequency[1])};
}

function cameraAnswer(c) {
  return {
    answer: {toml: '# mock ' + JSON.stringify(c), name: c.name, fields: mockFields(c), warnings: []}
  };
}

function changed(c, key, value) {
  const field = mockFields(c).find((f) => f.key === key);
  if (!field) throw new MockError(`setting '${key}=${value}': ${key}: no such key`, key);
  let found = value;
  if (field.type === 'number' || field.type === 'integer') {
    found = Number(value);
    if (value.trim() === '' || !Number.isFinite(found))
      throw new MockError(
          `setting '${key}=${value}': ${key}: found ${value}; expected a finite number`, key);
    if (found < field.low || found > (field.high ?? Infinity))
      throw new MockError(
          `setting '${key}=${value}': ${key}: found ${value}; expected >= ${field.low}`, key);
  } else if (field.type === 'list') {
    try {
      found = JSON.parse(value);
    } catch {
      throw new MockError(`setting '${key}=${value}': ${key}: expected a list of numbers`, key);
    }
  }
  if (field.type === 'boolean') found = value === 'true';
  return {...c, [mockMembers[key] ?? 'other']: found};
}

function edgesOf(code, c) {
  if (code.file !== undefined) {
    let file;
    try {
      file = JSON.parse(code.file);
    } catch (error) {
      throw new MockError(`code file: ${error.message}`);
    }
    if (file.format !== 'tofsmith-code')
      throw new MockError('code file: format: expected \'tofsmith-code\'');
    return file;
  }
  const match = /^(sinusoid|square|hamiltonian)-k([3-9])$/.exec(code.name);
  if (!match) throw new MockError(`no code family or file is called '${code.name}'`);
  const K = Number(match[2]), step = (k) => k / K;
  const duty = match[1] === 'hamiltonian' ? Math.max(1 / c.peak, 0.02) : 0.5;
  const light = [], gate = [];
  for (let k = 0; k < K; ++k) {
    light.push(match[1] === 'sinusoid' ? [] : [0, duty]);
    const wrap = (x) => x - Math.floor(x);
    gate.push(
        match[1] === 'sinusoid' ?
            [] :
            k >= 2 && match[1] === 'hamiltonian' ?
            [step(k) / 2, step(k) / 2 + 0.25, step(k) / 2 + 0.5, step(k) / 2 + 0.75].map(wrap) :
            [wrap(step(k)), wrap(step(k) + 0.5)]);
  }
  return {format: 'tofsmith-code', version: 1, name: code.name, light, gate, K};
}

function waveOf(edges, N, phase, level, smooth) {
  let wave = new Float64Array(N);
  if (!edges.length)
    for (let n = 0; n < N; ++n) wave[n] = level / 2 * (1 + Math.cos(2 * Math.PI * (n / N - phase)));
  for (let e = 0; e + 1 < edges.length; e += 2) {
    const width = ((edges[e + 1] - edges[e]) % 1 + 1) % 1;
    for (let n = 0; n < N; ++n)
      if ((((n + 0.5) / N - edges[e]) % 1 + 1) % 1 < width) wave[n] = level;
  }
  for (let round = 0; round < smooth; ++round)
    wave = wave.map((v, n) => (wave[(n + N - 1) % N] + v + wave[(n + 1) % N]) / 3);
  return wave;
}

function codeAnswer(file, c) {
  const N = c.samples, K = file.K, smooth = c.kind === 'none' ? 0 : 6;
  const light = new Float64Array(K * N), lightBehind = new Float64Array(K * N),
        gates = new Float64Array(K * N), correlation = new Float64Array(K * N),
        curve = new Float64Array(3 * N);
  for (let k = 0; k < K; ++k) {
    const level = file.light[k].length ? c.peak * 0.8 : 2,
          m = waveOf(file.light[k], N, 0, level, smooth),
          d = waveOf(file.gate[k], N, k / K, 1, smooth);
    light.set(waveOf(file.light[k], N, 0, level, 0), k * N);
    lightBehind.set(m, k * N);
    gates.set(d, k * N);
    for (let z = 0; z < N; ++z) {
      let sum = 0;
      for (let n = 0; n < N; ++n) sum += m[n] * d[(n + z) % N];
      correlation[k * N + z] = sum / N;
      if (k < 3) curve[z * 3 + k] = sum / N - 0.5;
    }
  }
  return {
    answer: {
      name: file.name,
      measurements: K,
      exposures: K,
      taps: 1,
      range_m: 299792458 / 2 / c.f0,
      light: {array: 'light', shape: [K, N]},
      light_behind: {array: 'light_behind', shape: [K, N]},
      gates: {array: 'gates', shape: [K, N]},
      correlation: {array: 'correlation', shape: [K, N]},
      curve: {array: 'curve', shape: [N, 3]},
      curve_variance_kept: K > 3 ? 0.93 : 1,
      light_edges: file.light,
      gate_edges: file.gate,
      notes: []
    },
    arrays: {light, light_behind: lightBehind, gates, correlation, curve}
  };
}

function evaluated(request, c) {
  const file = edgesOf(request.code, c), points = [], gain = file.light[0].length ? 60 : 160;
  for (const s of c.signal)
    for (const a of c.ambient) {
      const bound = gain * Math.sqrt(s + a + c.read ** 2) / s / Math.sqrt(c.peak) * 15e6 / c.f0,
            jitter = 1 + 0.4 * Math.sin(request.seed * 7 + s + a) / Math.sqrt(request.trials);
      points.push({
        signal_e_per_s: s,
        ambient_e_per_s: a,
        linear_mde_m: 1.1 * bound * jitter,
        linear_se_m: bound / Math.sqrt(request.trials),
        circular_mde_m: bound * jitter,
        circular_se_m: bound * 0.7 / Math.sqrt(request.trials),
        linear_rmse_m: 2 * bound * jitter,
        linear_rmse_se_m: bound / Math.sqrt(request.trials),
        circular_rmse_m: 1.25 * bound * jitter,
        circular_rmse_se_m: bound * 0.7 / Math.sqrt(request.trials),
        outlier_rate: Math.min(0.7, bound / 10),
        cramer_rao_mae_m: bound * 0.9,
        receiver_bound_mae_m: bound * 0.4,
        direct_tof_bound_mae_m: bound * 0.2
      });
    }
  const mean = (key) =>
      Math.exp(points.reduce((sum, p) => sum + Math.log(p[key]), 0) / points.length);
  const of = (kind) => ({
    geometric_mean_m: mean(kind + '_mde_m'),
    geometric_mean_se_m: mean(kind + '_se_m') / 5,
    mean_m: mean(kind + '_mde_m'),
    mean_se_m: 0
  });
  return {
    answer: {
      document: {
        seed: request.seed,
        trials: request.trials,
        camera: {name: c.name, operating: {error: c.error}},
        method: 'zncc',
        codes: [{
          name: file.name,
          measurements: file.K,
          exposures: file.K,
          taps: 1,
          samples: c.samples,
          linear: of('linear'),
          circular: of('circular'),
          points
        }]
      }
    },
    arrays: {}
  };
}

function sceneAnswer(request, c) {
  const W = request.width, H = Math.round(W * 0.75), range = 299792458 / 2 / c.f0;
  if (!(W >= 8 && W <= 640)) throw new MockError('width: expected 8 to 640', 'width');
  const truth = new Float32Array(W * H), depth = new Float32Array(W * H),
        deviation = new Float32Array(W * H), spread = new Float32Array(W * H),
        status = new Uint8Array(W * H);
  let seed = request.seed;
  const random = () => {
    seed = (seed * 1103515245 + 12345) % 2147483648;
    return seed / 2147483648 - 0.5;
  };
  const sigma = (request.filter === 'off' ? 0.2 : 0.05) * Math.sqrt(15 / c.peak);
  for (let i = 0; i < W * H; ++i) {
    const x = i % W / W - 0.5, y = Math.floor(i / W) / H - 0.5, ball = 0.09 - x * x - y * y;
    truth[i] = range * (ball > 0 ? 0.4 - Math.sqrt(ball) * 0.5 : 0.6 - 0.3 * y);
    depth[i] = truth[i] + sigma * (random() + random() + random());
    spread[i] = sigma / 2 + x * x;
    status[i] = Math.abs(x) > 0.48 ? 3 : 0;
    if (status[i]) depth[i] = NaN;
    deviation[i] = depth[i] - truth[i];
  }
  const plane = (array) => ({array, shape: [H, W]});
  return {
    answer: {
      depth_m: plane('depth_m'),
      true_depth_m: plane('true_depth_m'),
      status: plane('status'),
      deviation_m: plane('deviation_m'),
      standard_deviation_m: plane('standard_deviation_m'),
      width: W,
      height: H,
      range_m: range,
      signal_e_per_s: request.signal ?? 1e4,
      ambient_e_per_s: request.ambient ?? 1e4,
      mean_error_m: sigma / 3,
      median_error_m: sigma / 4,
      ok_share: 0.96
    },
    arrays: {
      depth_m: depth,
      true_depth_m: truth,
      status,
      deviation_m: deviation,
      standard_deviation_m: spread
    }
  };
}

async function design(request, c) {
  for (let done = 0; done <= 20; ++done) {
    self.postMessage({
      id: request.id,
      progress: {done, total: 20, text: `best error ${(60 - done).toFixed(2)} mm`}
    });
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  const file = {...edgesOf({name: 'hamiltonian-k4'}, c), name: 'designed'};
  return {
    answer: {file: JSON.stringify(file), error_m: 0.04, explanation: 'Factorized Hamiltonian code.'}
  };
}

const mockAnswers = {
  about: () => ({
    answer: {
      version: '0.0.0-mock',
      families: mockFamilies.map((name) => ({name, title: name})),
      cameras: Object.keys(mockCameras),
      scenes: ['table-top', 'ball', 'wall'],
      filters: ['off', 'light', 'normal', 'strong'],
      pattern: ['hamiltonian-kK']
    }
  }),
  camera: (r) => cameraAnswer((r.changes ?? [])
                                  .reduce(
                                      (c, {key, value}) => changed(c, key, value),
                                      r.built_in ? builtIn(r.built_in) : parsed(r.camera))),
  set: (r, c) => {
    const reply = cameraAnswer(changed(c, r.key, r.value));
    reply.answer.change = {key: r.key, value: r.value};
    return reply;
  },
  code: (r, c) => codeAnswer(edgesOf(r.code, c), c),
  move_edge(r, c) {
    const file = structuredClone(edgesOf(r.code, c)),
          arm = r.arm === 'light' ? file.light : file.gate;
    if (!arm[r.measurement]?.length) throw new MockError('the waveform is not two-level');
    arm[r.measurement][r.edge] = (r.position % 1 + 1) % 1;
    if (!file.name.endsWith('-edited')) file.name += '-edited';
    const reply = codeAnswer(file, c);
    reply.answer.file = JSON.stringify(file);
    return reply;
  },
  evaluate: evaluated,
  scene: sceneAnswer,
  design,
  save_code: (r, c) => ({answer: {file: JSON.stringify(edgesOf(r.code, c))}}),
  command: (r) => ({
    answer: {
      command:
          `tofsmith ${r.what} ${r.codes?.join(' ') ?? ''} --camera ${r.built_in ?? r.camera_file}` +
          (r.changes ?? []).map(({key, value}) => ` --set '${key}=${value}'`).join('')
    }
  }),
};

self.onmessage = async ({data}) => {
  if ('start' in data) {
    self.postMessage({ready: true});
    return;
  }
  try {
    const call = mockAnswers[data.call];
    if (!call) throw new MockError(`no such call: ${data.call}`);
    const reply = await call(data, data.camera === undefined ? null : parsed(data.camera));
    self.postMessage(
        {id: data.id, ...reply}, Object.values(reply.arrays ?? {}).map((array) => array.buffer));
  } catch (error) {
    self.postMessage({id: data.id, error: {message: error.message, field: error.field}});
  }
};
