// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the kernels of Monte Carlo trials are told, in C++ and in OpenCL C alike: doubles first, then
// an even number of members of 4 bytes. `int` beside a name in the plural says where a table stands
// in the memory of tables, in words of 4 bytes; -1: nowhere.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// As DepthTrials at one of its points.
struct TrialParameters {
  double first;  ///< number of the first trial within its round
  double rows_per_trial, rows, rows_per_bin;
  double signal_e_per_s;          ///< of albedo 1
  double prior_begin, prior_end;  ///< as DepthPrior
  double margin;                  ///< times the bounds on what the device may differ by

  unsigned int seed_low, seed_high, point_low, point_high, first_of_stream;
  int trials;
  float signal;  ///< where albedo is not uniform
  int has_uniform_albedo, on_bins;
  int prior_parts, prior_masses, prior_below;  ///< no parts: all depths are alike

  // What taps gather, as TrialModel at one ambient light.
  int taps, has_own_shot_noise;
  int records, record_stride, mean_floors, shot_floors;

  int weights, products, offsets, covariances;  ///< as PlaneNoise

  // As TapConversion.
  int is_poisson, has_adc, is_signed;
  float read_noise_e, full_well_e, dn_per_e, black_level_dn, min_dn, max_dn;
  int max_electrons;  ///< of every tap

  // As RowTrials at one ambient light: what a point of depth brings per unit of signal, what
  // stands beside it, and of Poisson noise the weights of rows.
  int row_points, row_floors, row_weights;
  int points_per_bin;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
