// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Trials whose noise is drawn for every measurement: of taps as DepthTrials::draw_measurements(), of
// rows as RowTrials. Compiled behind trials.cl.

/// As draw_poisson().
double draw_poisson(const struct TrialParameters* p, struct Doubt* doubt, int draw, int trial,
                    double mean) {
  if (!(mean > 0.0)) return 0.0;
  const uint first_block = (1u << 30) + (uint)draw * (1u << 18);
  uint4 words;
  for (uint attempt = 0;; ++attempt) {
    if (attempt % 2 == 0) words = trial_words(p, first_block + attempt / 2, trial);
    const uint2 two = attempt % 2 == 0 ? words.xy : words.zw;
    if (mean < 10.0) return inverted_poisson(doubt, mean, two);
    const double k = attempted_poisson(doubt, mean, two);
    if (k >= 0.0 || doubt->is_open) return k;
  }
}

/// As DepthTrials::draw_signed().
float draw_signed(const struct TrialParameters* p, struct Doubt* doubt, int k, int trial,
                  struct Electrons expected) {
  const struct SignedElectrons e =
      signed_electrons((double)expected.mean, (double)expected.shot);
  const double plus = draw_poisson(p, doubt, 2 * k, trial, e.plus);
  const double minus = draw_poisson(p, doubt, 2 * k + 1, trial, e.minus);
  return (float)(e.size * (plus - minus));
}

/// As read_out_taps().
float read_out(const struct TrialParameters* p, Floats tables, int k, float drawn, float shot,
               float normal) {
  const float sigma = p->read_noise_e;
  float deviation = sigma;
  if (!p->is_poisson) {
    const float variance = product_plus(sigma, sigma, shot);
    deviation = variance * reciprocal_sqrt(variance);
  }
  float e = product_plus(deviation, normal, drawn);
  if (p->max_electrons >= 0) {
    const float most = tables[p->max_electrons + k];
    e = fmin(fmax(e, p->is_signed ? -most : 0.0f), most);
  }
  e = fmin(e, p->full_well_e);
  if (p->is_signed) e = fmax(e, -p->full_well_e);
  if (!p->has_adc) return e;
  return fmin(fmax(rint(product_plus(e, p->dn_per_e, p->black_level_dn)), p->min_dn), p->max_dn);
}

void draw_taps(const struct TrialParameters* p, Floats tables, struct Doubt* doubt,
               struct Place place, float signal, int trial, const float* normals, float* raw) {
  float taps[TAPS];
  for (int k = 0; k < p->taps; ++k) {
    const struct Electrons e = electrons_of_tap(p, tables, place, signal, k);
    float drawn = e.mean;
    if (p->is_poisson)
      drawn = p->is_signed ? draw_signed(p, doubt, k, trial, e)
                           : (float)draw_poisson(p, doubt, k, trial, (double)e.mean);
    taps[k] = read_out(p, tables, k, drawn, e.shot, normals[k]);
  }
#if TAPS > MEASUREMENTS
  for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = taps[2 * k] - taps[2 * k + 1];
#else
  for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = taps[k];
#endif
}

/// As RowTrials::draw_poisson_rows().
void draw_poisson_rows(const struct TrialParameters* p, Floats tables, struct Doubt* doubt,
                       struct Place place, float signal, int trial, const float* normals,
                       float* raw) {
  const int points = (int)p->rows, samples = points / p->points_per_bin;
  Doubles light = (Doubles)(tables + p->row_points);
  const double floor_e = *(Doubles)(tables + p->row_floors);
  for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = p->read_noise_e * normals[k];
  for (int n = 0; n < samples; ++n) {
    int at = place.row - n * p->points_per_bin;
    if (at < 0) at += points;
    const double mean =
        (double)signal * (light[at] + (double)place.share * (light[at + 1] - light[at])) + floor_e;
    const float count = (float)draw_poisson(p, doubt, n, trial, mean);
    for (int k = 0; k < MEASUREMENTS; ++k) {
      const float weight = tables[p->row_weights + n * MEASUREMENTS + k];
      if (weight != 0.0f) raw[k] += weight * count;
    }
  }
}

/// A mean or covariance, as RowTrials has it.
double row_value(double signal, double share, double below, double above, double rest) {
  return signal * ((1.0 - share) * below + share * above) + rest;
}

/// As RowTrials::draw_normal_rows().
void draw_normal_rows(const struct TrialParameters* p, Floats tables, struct Place place,
                      float signal, const float* normals, float* raw) {
  const int numbers = MEASUREMENTS + MEASUREMENTS * (MEASUREMENTS + 1) / 2;
  const int points = (int)p->rows, next = place.row + 1 < points ? place.row + 1 : 0;
  Doubles below = (Doubles)(tables + p->row_points) + (size_t)place.row * (size_t)numbers;
  Doubles above = (Doubles)(tables + p->row_points) + (size_t)next * (size_t)numbers;
  Doubles floors = (Doubles)(tables + p->row_floors);
  double value[MEASUREMENTS], covariance[MEASUREMENTS][MEASUREMENTS];
  const double s = signal, share = place.share;
  int at = 0, order[MEASUREMENTS];
  for (; at < MEASUREMENTS; ++at) {
    value[at] = row_value(s, share, below[at], above[at], floors[at]);
    order[at] = at;
  }
  for (int i = 0; i < MEASUREMENTS; ++i)
    for (int j = 0; j <= i; ++j, ++at)
      covariance[i][j] = covariance[j][i] =
          row_value(s, share, below[at], above[at], floors[at]);

  for (int k = 0; k < MEASUREMENTS; ++k) {
    int largest = k;
    for (int i = k + 1; i < MEASUREMENTS; ++i)
      if (covariance[order[i]][order[i]] > covariance[order[largest]][order[largest]]) largest = i;
    const int pivot = order[largest];
    order[largest] = order[k];
    order[k] = pivot;
    const double variance = covariance[pivot][pivot];
    if (!(variance > 0.0)) break;
    const double noise = sqrt(variance) * (double)normals[k];
    value[pivot] += noise;
    for (int a = k + 1; a < MEASUREMENTS; ++a) {
      const int i = order[a];
      const double part = covariance[i][pivot] / variance;
      value[i] += part * noise;
      for (int b = k + 1; b <= a; ++b) {
        const int j = order[b];
        covariance[i][j] -= part * covariance[j][pivot];
        covariance[j][i] = covariance[i][j];
      }
    }
  }
  for (int k = 0; k < MEASUREMENTS; ++k) raw[k] = (float)value[k];
}

/// True positions [bin] and raw numbers of trials, measurement after measurement, and those that
/// the processor is to draw. Each is of one measurement.
kernel void draw_measurements(const struct TrialParameters parameters, Floats tables,
                              global double* true_bins, global float* numbers,
                              global float* averaged, global int* opened, global int* open) {
  const int trial = (int)get_global_id(0);
  const struct TrialParameters* p = &parameters;
  if (trial >= p->trials) return;
  const bool has_rows = p->row_points >= 0;
  float normals[TAPS + 1], raw[MEASUREMENTS];
  const struct Trial begun = begin_trial(p, tables, trial, has_rows ? MEASUREMENTS : p->taps,
                                         normals, true_bins);
  const struct Place place = begun.place;
  const float signal = begun.signal;

  struct Doubt doubt;
  doubt.margin = p->margin;
  doubt.step = 2e-15;
  doubt.is_open = 0;
  if (!has_rows)
    draw_taps(p, tables, &doubt, place, signal, trial, normals, raw);
  else if (p->is_poisson)
    draw_poisson_rows(p, tables, &doubt, place, signal, trial, normals, raw);
  else
    draw_normal_rows(p, tables, place, signal, normals, raw);
  for (int k = 0; k < MEASUREMENTS; ++k)
    numbers[(size_t)k * (size_t)p->trials + (size_t)trial] = raw[k];
  averaged[trial] = 1.0f;
  if (doubt.is_open) open[atomic_inc(opened)] = trial;
}
