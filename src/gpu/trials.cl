// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Monte Carlo trials with normal noise in the plane that ZNCC looks at, as DepthTrials draws them:
// from the same words, in single precision as there. Compiled behind random.cl, with RANK and
// MEASUREMENTS.

/// As draw_words().
uint4 trial_words(const struct TrialParameters* p, uint block, int trial) {
  const uint4 counter =
      (uint4)(block, p->first_of_stream + (uint)trial, p->point_low, p->point_high);
  return philox(counter, (uint2)(p->seed_low, p->seed_high));
}

/// Two normals, as normals_of().
float2 normals_of(uint radius, uint angle) {
  const float u = ((float)(radius >> 1) + 0.5f) * 0x1p-31f;
  const float length = sqrt(fmax(-2.0f * log(u), 0.0f));
  const float turn = ((float)((angle >> 8) & 0x3fffffu) + 0.5f) * 0x1p-22f;
  const float x = (turn - 0.5f) * 1.57079632679f;
  const float s = sin(x), c = cos(x);
  const bool is_odd = ((angle >> 30) & 1u) != 0;
  const float2 point = is_odd ? (float2)(-s, c) : (float2)(c, s);
  return ((angle >> 31) != 0 ? -length : length) * point;
}

/// The place of a depth in the records.
struct Place {
  int row;
  float share;
  double bin;
};

/// As place_depths().
struct Place place_depth(const struct TrialParameters* p, uint4 words, int trial) {
  const double bins_per_row = 1.0 / p->rows_per_bin;
  const double within =
      ((double)(((words.y & 0xffu) << 8) | (words.w & 0xffu)) + 0.5) * 0x1p-16;
  double at = (p->first + (double)trial + within) * p->rows_per_trial;
  at = fmin(at, p->rows * (1.0 - 0x1p-50));
  if (p->on_bins) at = floor(at * bins_per_row) * p->rows_per_bin;
  const double row = floor(at);
  struct Place place;
  place.row = (int)row;
  place.share = (float)(at - row);
  place.bin = at * bins_per_row;
  return place;
}

/// Adds L times normals, for the covariance with rows one after the other, as add_noise().
void add_plane_noise(float* covariance, const float* normals, float* q) {
  float inverse[RANK];
  for (int j = 0; j < RANK; ++j) {
    float* row = covariance + j * (j + 1) / 2;
    const float whole = row[j];
    float rest = whole;
    for (int l = 0; l < j; ++l) {
      const float* other = covariance + l * (l + 1) / 2;
      float sum = row[l];
      for (int m = 0; m < l; ++m) sum -= row[m] * other[m];
      row[l] = sum * inverse[l];
      rest -= row[l] * row[l];
    }
    inverse[j] = rest > whole * 1e-6f + 1e-30f ? 1.0f / sqrt(rest) : 0.0f;
    row[j] = rest * inverse[j];
    for (int l = 0; l <= j; ++l) q[j] += row[l] * normals[l];
  }
}

/// True positions [bin] and raw numbers of trials, measurement after measurement, that lie in the
/// plane where the trial does.
kernel void draw_trials(const struct TrialParameters parameters, Floats tables,
                        global double* true_bins, global float* numbers, global float* averaged) {
  const int trial = (int)get_global_id(0);
  const struct TrialParameters* p = &parameters;
  if (trial >= p->trials) return;
  uint4 words = trial_words(p, 0u, trial);
  const struct Place place = place_depth(p, words, trial);
  true_bins[trial] = place.bin;

  float normals[RANK + 1];
  for (int pair = 0; 2 * pair < RANK; ++pair) {
    if (pair > 0 && pair % 2 == 0) words = trial_words(p, (uint)(pair / 2), trial);
    const float2 two =
        pair % 2 == 0 ? normals_of(words.x, words.y) : normals_of(words.z, words.w);
    normals[2 * pair] = two.x;
    normals[2 * pair + 1] = two.y;
  }
  float signal = p->signal;
  if (p->has_uniform_albedo)
    signal = (float)(((double)trial_words(p, 1u << 29, trial).x + 0.5) * 0x1p-32 *
                     p->signal_e_per_s);

  float q[RANK], covariance[RANK * (RANK + 1) / 2];
  for (int j = 0; j < RANK; ++j) q[j] = tables[p->offsets + j];
  for (int i = 0; i < RANK * (RANK + 1) / 2; ++i) covariance[i] = tables[p->covariances + i];
  Floats record = tables + p->records + (size_t)(place.row + 1) * (size_t)p->record_stride;
  for (int k = 0; k < p->taps; ++k) {
    const float chi = place.share * record[p->taps + k] + record[k];
    float mean = signal * chi + tables[p->mean_floors + k], shot = mean;
    if (p->has_own_shot_noise) {
      const float shot_chi = place.share * record[3 * p->taps + k] + record[2 * p->taps + k];
      shot = signal * shot_chi + tables[p->shot_floors + k];
    } else {
      mean = fmax(mean, 0.0f);
    }
    shot = fmax(shot, 0.0f);
    for (int j = 0; j < RANK; ++j) q[j] += mean * tables[p->weights + k * RANK + j];
    for (int i = 0; i < RANK * (RANK + 1) / 2; ++i)
      covariance[i] += shot * tables[p->products + k * (RANK * (RANK + 1) / 2) + i];
  }
  add_plane_noise(covariance, normals, q);

  for (int k = 0; k < MEASUREMENTS; ++k) {
    float number = tables[p->numbers_of_plane + MEASUREMENTS * RANK + k];
    for (int j = 0; j < RANK; ++j) number += q[j] * tables[p->numbers_of_plane + k * RANK + j];
    numbers[(size_t)k * (size_t)p->trials + (size_t)trial] = number;
  }
  averaged[trial] = 1.0f;
}
