// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// From bins to planes, as src/decode/output/output_position-inl.hpp and output_noise-inl.hpp.

/// <q, vector> with a vector of the record.
float along_record(const float* q, Floats vector) {
  float sum = q[0] * vector[0];
  for (int j = 1; j < RANK; ++j) sum = q[j] * vector[j] + sum;
  return sum;
}

float electrons_of(const struct OutputParameters* p, Floats tables, float raw, int k) {
#ifdef HAS_DOUBLES
  global const double* dark = (global const double*)(tables + p->dark_raw);
  global const double* gain = (global const double*)(tables + p->gain_e_per_raw);
  return (float)(((double)raw - dark[k]) * gain[k]);
#else
  Floats dark = tables + p->dark_raw + 2 * k;
  const float lit = (raw - dark[0]) - dark[1];
  Floats gain = tables + p->gain_e_per_raw + 2 * k;
  return lit * gain[0] + lit * gain[1];
#endif
}

float variance_of(float signal, float ambient, Floats noise) {
  return fmax(signal * noise[0] + (ambient * noise[1] + noise[2]), 0.0f);
}

/// Returns true if the confidence is proven to be 1, as is_sure() in output_noise-inl.hpp.
bool is_sure(const struct OutputParameters* p, const float* q, Floats record, float signal,
             float ambient, float share) {
  Floats bound = record + RECORD_BOUND;
  float square = 0.0f;
  for (int j = 0; j < RANK; ++j) square = q[j] * q[j] + square;
  const float score = along_record(q, record + RECORD_POINT) * bound[0];
  const float across2 = fmax(square - score * score, 0.0f);
  const float other = score * bound[1] + sqrt(across2) * bound[2];
  const float lead = square - other * other - across2;
  const float variance =
      signal * bound[3] + (ambient * p->typical_ambient + p->typical_floor_e2);
  return other < score && lead >= p->sure_lead * (variance * share);
}

/// Best point on the chords left and right of a bin.
struct ChordPoint {
  bool has_depth, is_left;
  float t;       ///< share of the chord from the bin on
  float inside;  ///< signal, if there is depth
};

#ifdef RECORD_SLOPE
/// As refine_on_curve(), of a smooth curve.
struct ChordPoint best_point(const float* q, Floats record, int bin) {
  const float at_row = along_record(q, record + RECORD_POINT);
  const float g = along_record(q, record + RECORD_SLOPE);
  const float b = along_record(q, record + RECORD_BEND);
  const float c = along_record(q, record + RECORD_ASYMMETRY);
  float t = fmin(fmax(-(g / b), -1.0f), 1.0f);
  for (int step = 0; step < 2; ++step) {
    const float curvature = (c + c) * t + b;
    const float rise = t * (t * c + b) + g;
    if (curvature < 0.0f) t = fmin(fmax(t - rise / curvature, -1.0f), 1.0f);
  }
  if (!(b < 0.0f)) t = 0.0f;
  const float slopes = t * (t * (c * (1.0f / 3.0f)) + b * 0.5f) + g;
  const float growth = t * record[RECORD_GROWTH + 1] + record[RECORD_GROWTH];
  const float signal = (t * slopes + at_row) / (t * growth + 1.0f);
  struct ChordPoint point;
  point.is_left = t < 0.0f;
  point.has_depth = bin >= 0 && at_row > 0.0f && signal > 0.0f;
  point.inside = signal;
  point.t = point.has_depth ? fabs(t) : 0.0f;
  return point;
}
#else
struct ChordPoint best_point(const float* q, Floats record, int bin) {
  const float at_bin = along_record(q, record + RECORD_POINT);
  const float to_left = along_record(q, record + RECORD_LEFT);
  const float to_right = along_record(q, record + RECORD_RIGHT);
  const float turn_left = record[RECORD_TURN], turn_right = record[RECORD_TURN + 1];
  const float reach_left = record[RECORD_REACH], reach_right = record[RECORD_REACH + 1];
  const bool left_is_on = to_left > 0.0f && !(to_left * (reach_left + turn_left) > at_bin);
  const bool right_is_on = to_right > 0.0f && !(to_right * (reach_right + turn_right) > at_bin);
  struct ChordPoint point;
  point.is_left = left_is_on == right_is_on ? to_left >= to_right : left_is_on;
  const float rise = fmax(point.is_left ? to_left : to_right, 0.0f);
  point.inside = at_bin - rise * (point.is_left ? turn_left : turn_right);
  point.has_depth = bin >= 0 && at_bin > 0.0f && point.inside > 0.0f;
  const float reach = point.is_left ? reach_left : reach_right;
  point.t = point.has_depth ? fmin(rise * reach / point.inside, 1.0f) : 0.0f;
  return point;
}

#endif

/// How far from its bin each pixel is [bin], -1 .. 1.
kernel void write_offsets(const struct OutputParameters p, const struct TileParameters tile,
                          Floats tables, global const uchar* raw_numbers,
                          global const int* bins, global float* offsets) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= tile.pixels) return;
  const int bin = bins[pixel];
  if (bin == UNPROVEN) return;
  float raw[MEASUREMENTS], q[RANK];
  vector_of(&p.projection, &tile, tables, raw_numbers, pixel, raw, q);
  const struct ChordPoint point =
      best_point(q, tables + p.records + (bin + 1) * p.record_stride, bin);
  offsets[pixel] = point.is_left ? -point.t : point.t;
}

/// Planes that are null are not wanted. Pixels without a proven bin are left to the host, and so are
/// those whose confidence is not proven to be 1.
kernel void write_planes(const struct OutputParameters p, const struct TileParameters tile,
                         Floats tables, global const uchar* raw_numbers, Floats averaged,
                         global const int* bins, global int* opened, global int* open,
                         global float* depth_m, global float* signal_e_per_s,
                         global float* ambient_e_per_s, global float* confidences,
                         global float* deviation_m, global uchar* status) {
  const int pixel = (int)get_global_id(0);
  if (pixel >= tile.pixels) return;
  const int bin = bins[pixel];
  if (bin == UNPROVEN) return;
  float raw[MEASUREMENTS], q[RANK];
  vector_of(&p.projection, &tile, tables, raw_numbers, pixel, raw, q);
  Floats record = tables + p.records + (bin + 1) * p.record_stride;
  const struct ChordPoint point = best_point(q, record, bin);
  const bool has_depth = point.has_depth;
  const float t = point.t, signal = has_depth ? point.inside : 0.0f,
              offset = point.is_left ? -t : t;

  if (depth_m) {
    const float whole = bin == 0 && offset < 0.0f ? (float)p.samples : (float)bin;
    const float rest = offset * p.bin_m + whole * p.bin_low_m;
    const float depth = whole * p.bin_high_m + rest;
    depth_m[pixel] = !has_depth ? NO_VALUE : depth >= p.range_m ? 0.0f : depth;
  }
  if (signal_e_per_s) signal_e_per_s[pixel] = has_depth ? signal : NO_VALUE;

  const int quarter = min((int)(t * (float)p.chord_quarters), p.chord_quarters - 1) + 1;
  const int steps = t == 0.0f ? 0 : point.is_left ? -quarter : quarter;
  Floats chord = tables + p.chords +
                 ((bin + 1) * p.chord_blocks + p.chord_quarters + steps) * CHORD_FIELDS;
  float ambient = 0.0f;
  if (p.sees_ambient && (ambient_e_per_s || confidences || deviation_m || status)) {
    float sum = electrons_of(&p, tables, raw[0], 0) * tables[p.ambient_weights];
    for (int k = 1; k < MEASUREMENTS; ++k)
      sum = electrons_of(&p, tables, raw[k], k) * tables[p.ambient_weights + k] + sum;
    ambient = sum - signal * (t * chord[CHORD_AMBIENT] + record[RECORD_AMBIENT]);
  }
  if (ambient_e_per_s) ambient_e_per_s[pixel] = p.sees_ambient && has_depth ? ambient : NO_VALUE;

  const float noisy_ambient = fmax(ambient, 0.0f);
  const float share = averaged ? 1.0f / averaged[pixel] : 1.0f;
  if (deviation_m) {
    const float variance = variance_of(signal, noisy_ambient, chord + CHORD_DEPTH_NOISE);
    deviation_m[pixel] = has_depth ? sqrt(variance * share) / signal : NO_VALUE;
  }
  if (p.finds_confidence && has_depth && !is_sure(&p, q, record, signal, noisy_ambient, share))
    open[atomic_inc(opened)] = pixel;
  if (confidences) confidences[pixel] = has_depth ? 1.0f : NO_VALUE;
  if (status) {
    const float noise = variance_of(signal, noisy_ambient, record + RECORD_SIGNAL_NOISE) * share;
    uchar value = STATUS_OK;
    if (signal * signal < p.low_signal_sigma2 * noise) value = STATUS_LOW_SIGNAL;
    if (!has_depth) value = STATUS_NO_RETURN;
    for (int k = 0; k < MEASUREMENTS; ++k)
      if (raw[k] >= p.highest || raw[k] <= p.lowest) value = STATUS_SATURATED;
    if (bin < 0) value = STATUS_INVALID;
    status[pixel] = value;
  }
}

/// Raw numbers of some pixels and of how many measurements they are the mean: K + 1 numbers each.
kernel void gather_numbers(const struct TileParameters tile, global const uchar* raw_numbers,
                           Floats averaged, Ints pixels, const int count, global float* numbers) {
  const int i = (int)get_global_id(0);
  if (i >= count) return;
  const int pixel = pixels[i];
  for (int k = 0; k < MEASUREMENTS; ++k)
    numbers[i * (MEASUREMENTS + 1) + k] = raw_number(&tile, raw_numbers, pixel, k);
  numbers[i * (MEASUREMENTS + 1) + MEASUREMENTS] = averaged ? averaged[pixel] : 1.0f;
}

/// Puts values of some pixels where they belong in a plane.
kernel void scatter_values(Ints pixels, const int count, Floats values, global float* plane) {
  const int i = (int)get_global_id(0);
  if (i < count) plane[pixels[i]] = values[i];
}
