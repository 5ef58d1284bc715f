// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the kernel of Monte Carlo trials is told, in C++ and in OpenCL C alike: doubles first, then
// an even number of members of 4 bytes. `int` beside a name in the plural says where a table stands
// in the memory of tables, in words of 4 bytes.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// As DepthTrials and the PlaneNoise of a point.
struct TrialParameters {
  double first;  ///< number of the first trial within its round
  double rows_per_trial, rows, rows_per_bin;
  double signal_e_per_s;  ///< of albedo 1

  unsigned int seed_low, seed_high, point_low, point_high, first_of_stream;
  int trials;
  float signal;  ///< where albedo is not uniform
  int has_uniform_albedo, on_bins, has_own_shot_noise, taps;
  int records, record_stride;
  int mean_floors, shot_floors, weights, products, offsets, covariances;  ///< as PlaneNoise
  int numbers_of_plane;  ///< (K, rank), and (K) to be added
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
