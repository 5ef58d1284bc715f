// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Monte Carlo trials as DepthTrials draws them: depth, light, and noise in the plane that ZNCC looks
// at. From the same words, step by step: the same bits. Compiled behind random.cl, vector_math.cl
// and trial_parameters.h, ahead of trial_measurements.cl, with RANK, MEASUREMENTS and TAPS.

/// As draw_words().
uint4 trial_words(const struct TrialParameters* p, uint block, int trial) {
  const uint4 counter =
      (uint4)(block, p->first_of_stream + (uint)trial, p->point_low, p->point_high);
  return philox(counter, (uint2)(p->seed_low, p->seed_high));
}

/// As DepthTrials::draw_normals(). @param words  of block 0
void draw_normals(const struct TrialParameters* p, int trial, uint4 words, int count,
                  float* normals) {
  for (int pair = 0; 2 * pair < count; ++pair) {
    if (pair > 0 && pair % 2 == 0) words = trial_words(p, (uint)(pair / 2), trial);
    const float2 two =
        pair % 2 == 0 ? normals_of(words.x, words.y) : normals_of(words.z, words.w);
    normals[2 * pair] = two.x;
    normals[2 * pair + 1] = two.y;
  }
}

/// As DepthTrials::draw_signal().
float draw_signal(const struct TrialParameters* p, int trial) {
  if (!p->has_uniform_albedo) return p->signal;
  return (float)(((double)trial_words(p, 1u << 29, trial).x + 0.5) * 0x1p-32 *
                 p->signal_e_per_s);
}

double begin_of_part(const struct TrialParameters* p, int part) {
  return p->prior_begin +
         (p->prior_end - p->prior_begin) * ((double)part / (double)p->prior_parts);
}

/// As DepthPrior::quantile().
double depth_quantile(const struct TrialParameters* p, Floats tables, double share) {
  Doubles masses = (Doubles)(tables + p->prior_masses), below = (Doubles)(tables + p->prior_below);
  int part = 0;
  for (int end = p->prior_parts; end - part > 1;) {
    const int middle = (part + end) / 2;
    if (below[middle] > share)
      end = middle;
    else
      part = middle;
  }
  while (masses[part] == 0.0) --part;
  const double within = fmin(fmax((share - below[part]) / masses[part], 0.0), 1.0);
  const double begin = begin_of_part(p, part);
  return fmin(begin + within * (begin_of_part(p, part + 1) - begin), 1.0 - 0x1p-53);
}

/// The place of a depth in the records.
struct Place {
  int row;
  float share;
  double bin;
};

/// As place_depths(), and move_depths(). @param words  of block 0
struct Place place_depth(const struct TrialParameters* p, Floats tables, uint4 words, int trial) {
  const double bins_per_row = 1.0 / p->rows_per_bin;
  const double within =
      ((double)(((words.y & 0xffu) << 8) | (words.w & 0xffu)) + 0.5) * 0x1p-16;
  double at = (p->first + (double)trial + within) * p->rows_per_trial;
  at = fmin(at, p->rows * (1.0 - 0x1p-50));
  struct Place place;
  if (p->prior_parts == 0) {
    if (p->on_bins) at = floor(at * bins_per_row) * p->rows_per_bin;
    place.bin = at * bins_per_row;
  } else {
    const double samples = p->rows * bins_per_row;
    place.bin = depth_quantile(p, tables, at * bins_per_row / samples) * samples;
    if (p->on_bins) place.bin = floor(place.bin);
    place.bin = fmin(place.bin, nextafter(samples, 0.0));
    at = place.bin * p->rows_per_bin;
  }
  const double row = floor(at);
  place.row = (int)row;
  place.share = (float)(at - row);
  return place;
}

/// Electrons that a tap is expected to gather, and their shot noise.
struct Electrons {
  float mean, shot;
};

/// As draw_plane() and expect_electrons().
struct Electrons electrons_of_tap(const struct TrialParameters* p, Floats tables,
                                  struct Place place, float signal, int k) {
  Floats record = tables + p->records + (size_t)(place.row + 1) * (size_t)p->record_stride;
  struct Electrons e;
  const float chi = product_plus(place.share, record[p->taps + k], record[k]);
  e.mean = product_plus(signal, chi, tables[p->mean_floors + k]);
  if (p->has_own_shot_noise) {
    const float shot_chi =
        product_plus(place.share, record[3 * p->taps + k], record[2 * p->taps + k]);
    e.shot = fmax(product_plus(signal, shot_chi, tables[p->shot_floors + k]), 0.0f);
  } else {
    e.mean = fmax(e.mean, 0.0f);
    e.shot = e.mean;
  }
  return e;
}

/// Adds L times normals, for the covariance with rows one after the other, as add_noise().
void add_plane_noise(float* covariance, const float* normals, float* q) {
  float inverse[RANK];
  for (int j = 0; j < RANK; ++j) {
    float* row = covariance + j * (j + 1) / 2;
    const float all = row[j];
    float rest = all;
    for (int l = 0; l < j; ++l) {
      const float* other = covariance + l * (l + 1) / 2;
      float sum = row[l];
      for (int m = 0; m < l; ++m) sum = product_plus(-row[m], other[m], sum);
      row[l] = sum * inverse[l];
      rest = product_plus(-row[l], row[l], rest);
    }
    const bool is_seen = rest > product_plus(all, 1e-6f, 1e-30f);
    inverse[j] = is_seen ? reciprocal_sqrt(fmax(rest, 1e-30f)) : 0.0f;
    row[j] = rest * inverse[j];
    for (int l = 0; l <= j; ++l) q[j] = product_plus(row[l], normals[l], q[j]);
  }
}

/// Where the depth of a trial lies, and the signal of its light.
struct Trial {
  struct Place place;
  float signal;
};

/// Begins a trial, with so many normals: its true position [bin] is written.
struct Trial begin_trial(const struct TrialParameters* p, Floats tables, int trial, int count,
                         float* normals, global double* true_bins) {
  const uint4 words = trial_words(p, 0u, trial);
  struct Trial begun;
  begun.place = place_depth(p, tables, words, trial);
  true_bins[trial] = begun.place.bin;
  draw_normals(p, trial, words, count, normals);
  begun.signal = draw_signal(p, trial);
  return begun;
}

/// True positions [bin] of trials, and where their measurements lie in the plane, coordinate after
/// coordinate. Each is of one measurement.
kernel void draw_in_plane(const struct TrialParameters parameters, Floats tables,
                          global double* true_bins, global float* plane, global float* averaged) {
  const int trial = (int)get_global_id(0);
  const struct TrialParameters* p = &parameters;
  if (trial >= p->trials) return;
  float normals[RANK + 1];
  const struct Trial begun = begin_trial(p, tables, trial, RANK, normals, true_bins);

  const int pairs = RANK * (RANK + 1) / 2;
  float q[RANK], covariance[RANK * (RANK + 1) / 2];
  for (int j = 0; j < RANK; ++j) q[j] = tables[p->offsets + j];
  for (int i = 0; i < pairs; ++i) covariance[i] = tables[p->covariances + i];
  for (int k = 0; k < p->taps; ++k) {
    const struct Electrons e = electrons_of_tap(p, tables, begun.place, begun.signal, k);
    for (int j = 0; j < RANK; ++j)
      q[j] = product_plus(e.mean, tables[p->weights + k * RANK + j], q[j]);
    for (int i = 0; i < pairs; ++i)
      covariance[i] = product_plus(e.shot, tables[p->products + k * pairs + i], covariance[i]);
  }
  add_plane_noise(covariance, normals, q);
  for (int j = 0; j < RANK; ++j) plane[(size_t)j * (size_t)p->trials + (size_t)trial] = q[j];
  averaged[trial] = 1.0f;
}
