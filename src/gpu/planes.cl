// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Computes planes from bins, as src/decode/output/output_*-inl.hpp.

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

/// As is_sure() in output_noise-inl.hpp.
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

struct ChordPoint {
  bool has_depth, is_left;
  float t;       ///< 0 at the bin
  float inside;  ///< signal
};

#ifdef RECORD_SLOPE
/// As refine_on_curve().
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

#define LEAST_FLOAT 1.17549435e-38f

float less_square(float a, float b, float c) {
  const float share = b / fmax(c, LEAST_FLOAT);
  return a - share * b;
}

#ifdef RECORD_SLOPE
void normalize_in_plane(float* vector, float square) {
  const float scale = 1.0f / sqrt(fmax(square, LEAST_FLOAT));
  for (int j = 0; j < RANK; ++j) vector[j] *= scale;
}

/// As find_tangent(). @return true if the pixel is on the side of the previous row
bool find_tangent(const float* q, Floats record, float t, float* direction, float* slope) {
  float own = 0.0f, own_slope = 0.0f;
  for (int j = 0; j < RANK; ++j) {
    const float w = record[RECORD_SLOPE + j], b = record[RECORD_BEND + j];
    const float c = record[RECORD_ASYMMETRY + j];
    slope[j] = t * (t * c + b) + w;
    direction[j] = t * (t * (t * (c * (1.0f / 3.0f)) + b * 0.5f) + w) + record[RECORD_POINT + j];
    own = direction[j] * direction[j] + own;
    own_slope = slope[j] * slope[j] + own_slope;
  }
  normalize_in_plane(direction, own);
  normalize_in_plane(slope, own_slope);
  return t < 0.0f;
}
#else
/// As find_chord(). @return true for the left chord
bool find_tangent(const float* q, Floats record, float t, float* direction, float* slope) {
  const float to_left = along_record(q, record + RECORD_LEFT),
              to_right = along_record(q, record + RECORD_RIGHT);
  const bool is_left = t < 0.0f || (t == 0.0f && fabs(to_left) >= fabs(to_right));
  for (int j = 0; j < RANK; ++j) {
    direction[j] = record[RECORD_POINT + j] * record[RECORD_BOUND];
    slope[j] = record[(is_left ? RECORD_LEFT : RECORD_RIGHT) + j];
  }
  return is_left;
}
#endif

/// Computes the components that the fitted light does not explain, in the subspace and outside it.
/// @return sum of their squares
float unexplained(const struct OutputParameters* p, Floats tables, const float* raw, const float* q,
                  const float* direction, const float* slope, float* component) {
  float score = q[0] * direction[0], rise = q[0] * slope[0], square = 0.0f;
  for (int j = 1; j < RANK; ++j) {
    score = q[j] * direction[j] + score;
    rise = q[j] * slope[j] + rise;
  }
  for (int j = 0; j < RANK; ++j) {
    const float along_slope = rise * slope[j];
    const float found = score * direction[j] + along_slope;
    component[j] = q[j] - found;
    square = component[j] * component[j] + square;
  }
  for (int m = 0; m < p->off_plane_count; ++m) {
    Floats weight = tables + p->off_plane + m * MEASUREMENTS;
    float rest = electrons_of(p, tables, raw[0], 0) * weight[0];
    for (int k = 1; k < MEASUREMENTS; ++k)
      rest = electrons_of(p, tables, raw[k], k) * weight[k] + rest;
    component[RANK + m] = rest;
    square = rest * rest + square;
  }
  return square;
}

/// Chi-square of the weighted fit of ambient light, signal and depth.
float weighted_squares(const struct OutputParameters* p, Floats tables, Floats record,
                       Floats beside, float t, float signal, float ambient, const float* component,
                       const float* direction, const float* slope) {
  const float least =
      signal * p->least_shot + (ambient * p->least_shot_ambient + p->least_floor_e2);
  const float rest = 1.0f - t;
  const int components = RANK + p->off_plane_count;
  float aa = 0.0f, ax = 0.0f, as = 0.0f, ar = 0.0f, xx = 0.0f, xs = 0.0f, xr = 0.0f, ss = 0.0f,
        sr = 0.0f, rr = 0.0f;
  for (int k = 0; k < MEASUREMENTS; ++k) {
    const float shot_beside = t * beside[RECORD_SHOT + k];
    const float shot = rest * record[RECORD_SHOT + k] + shot_beside;
    const float without_signal =
        ambient * tables[p->shot_ambient + k] + tables[p->floor_noise + k];
    const float variance = fmax(signal * shot + without_signal, least);
    Floats basis = tables + p->residual_basis + k * components;
    float x = 0.0f, s = 0.0f, r = 0.0f;
    for (int j = 0; j < RANK; ++j) {
      x = direction[j] * basis[j] + x;
      s = slope[j] * basis[j] + s;
    }
    for (int j = 0; j < components; ++j) r = component[j] * basis[j] + r;
    const float a = tables[p->ambient_direction + k], weight = 1.0f / variance;
    const float by_a = weight * a, by_x = weight * x, by_s = weight * s, by_r = weight * r;
    aa = by_a * a + aa;
    ax = by_a * x + ax;
    as = by_a * s + as;
    ar = by_a * r + ar;
    xx = by_x * x + xx;
    xs = by_x * s + xs;
    xr = by_x * r + xr;
    ss = by_s * s + ss;
    sr = by_s * r + sr;
    rr = by_r * r + rr;
  }
  if (p->sees_ambient) {
    const float of_x = ax / aa, of_s = as / aa;
    xx = xx - of_x * ax;
    xs = xs - of_x * as;
    xr = xr - of_x * ar;
    ss = ss - of_s * as;
    sr = sr - of_s * ar;
    rr = less_square(rr, ar, aa);
  }
  const float of_s = xs / fmax(xx, LEAST_FLOAT);
  ss = ss - of_s * xs;
  sr = sr - of_s * xr;
  rr = less_square(rr, xr, xx);
  return fmax(less_square(rr, sr, ss), 0.0f);
}

/// Returns true for an inconsistent pixel. Writes chi-square per degree of freedom to `residual`,
/// if any.
bool find_residual(const struct OutputParameters* p, Floats tables, const float* raw,
                   const float* q, Floats record, int bin, float offset, float signal,
                   float ambient, float share, float* residual) {
  float component[MEASUREMENTS], direction[RANK], slope[RANK];
  const bool is_left = find_tangent(q, record, offset, direction, slope);
  const float square = unexplained(p, tables, raw, q, direction, slope, component);
  Floats limit = tables + p->limits + (bin + 1) * p->limit_stride;
  const float bound = variance_of(signal, ambient, limit + LIMIT_VARIANCE) * share;
  const float from_noise = sqrt(bound), error = signal * limit[LIMIT_ERROR];
  const float longest = from_noise + fmin(error, error * error * p->half_quantile / from_noise);
  const bool is_open = square > longest * longest;
  if (!is_open && !residual) return false;
  int next = bin + (is_left ? -1 : 1);
  if (next < 0) next = p->samples - 1;
  if (next >= p->samples) next = 0;
  Floats beside = tables + p->records + (next + 1) * p->record_stride;
  const float chi2 = weighted_squares(p, tables, record, beside, fabs(offset), signal, ambient,
                                      component, direction, slope) /
                     share;
  if (residual) *residual = chi2 * limit[LIMIT_PER_FREEDOM];
  return is_open && sqrt(chi2 * bound) > limit[LIMIT_ROOT] * longest;
}

/// Planes that are null are not computed. Pixels without a proven bin or confidence are left to the
/// host.
kernel void write_planes(const struct OutputParameters p, const struct TileParameters tile,
                         Floats tables, global const uchar* raw_numbers, Floats averaged,
                         global const int* bins, global int* opened, global int* open,
                         global float* depth_m, global float* signal_e_per_s,
                         global float* ambient_e_per_s, global float* confidences,
                         global float* deviation_m, global uchar* status,
                         global float* residuals) {
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
  if (p.sees_ambient && (ambient_e_per_s || confidences || deviation_m || status || residuals)) {
    float sum = electrons_of(&p, tables, raw[0], 0) * tables[p.ambient_weights];
    for (int k = 1; k < MEASUREMENTS; ++k)
      sum = electrons_of(&p, tables, raw[k], k) * tables[p.ambient_weights + k] + sum;
    ambient = sum - signal * (t * chord[CHORD_AMBIENT] + record[RECORD_AMBIENT]);
  }
  if (ambient_e_per_s) ambient_e_per_s[pixel] = p.sees_ambient && has_depth ? ambient : NO_VALUE;

  const float noisy_ambient = fmax(ambient, 0.0f);
  const bool is_mean = averaged && averaged[pixel] > 1.0f;
  const float share = averaged ? 1.0f / averaged[pixel] : 1.0f;
  const float lobe_share = is_mean ? share * p.lobe_noise : share,
              residual_share = is_mean ? share * p.residual_noise : share;
  if (deviation_m) {
    const float variance = variance_of(signal, noisy_ambient, chord + CHORD_DEPTH_NOISE);
    deviation_m[pixel] = has_depth ? sqrt(variance * share) / signal : NO_VALUE;
  }
  if (p.finds_confidence && has_depth &&
      !is_sure(&p, q, record, signal, noisy_ambient, lobe_share))
    open[atomic_inc(opened)] = pixel;
  if (confidences) confidences[pixel] = has_depth ? 1.0f : NO_VALUE;
  bool is_inconsistent = false;
  if (p.finds_residual) {
    float residual = NO_VALUE;
    is_inconsistent =
        find_residual(&p, tables, raw, q, record, bin, offset, signal, noisy_ambient,
                      residual_share, residuals ? &residual : 0);
    // The bits of NaN depend on the device.
    if (residuals) residuals[pixel] = has_depth && !isnan(residual) ? residual : NO_VALUE;
  }
  if (status) {
    const float noise = variance_of(signal, noisy_ambient, record + RECORD_SIGNAL_NOISE) * share;
    uchar value = is_inconsistent ? STATUS_inconsistent : STATUS_ok;
    if (signal * signal < p.low_signal_sigma2 * noise) value = STATUS_low_signal;
    if (!has_depth) value = STATUS_no_return;
    for (int k = 0; k < MEASUREMENTS; ++k)
      if (raw[k] >= p.highest || raw[k] <= p.lowest) value = STATUS_saturated;
    if (bin < 0) value = STATUS_invalid;
    status[pixel] = value;
  }
}

/// Gathers K + 1 numbers per listed pixel: raw numbers and averaged count.
kernel void gather_numbers(const struct TileParameters tile, global const uchar* raw_numbers,
                           Floats averaged, Ints pixels, const int count, global float* numbers) {
  const int i = (int)get_global_id(0);
  if (i >= count) return;
  const int pixel = pixels[i];
  for (int k = 0; k < MEASUREMENTS; ++k)
    numbers[i * (MEASUREMENTS + 1) + k] = raw_number(&tile, raw_numbers, pixel, k);
  numbers[i * (MEASUREMENTS + 1) + MEASUREMENTS] = averaged ? averaged[pixel] : 1.0f;
}

kernel void scatter_values(Ints pixels, const int count, Floats values, global float* plane) {
  const int i = (int)get_global_id(0);
  if (i < count) plane[pixels[i]] = values[i];
}
