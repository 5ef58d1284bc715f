// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the kernels of filters in time are told, in C++ and in OpenCL C alike, as
// decode_parameters.h.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// Planes of a frame beside what was added up (H, W).
enum TimePlane {
  time_usable,      ///< 1 where both are measurements of light, else 0
  time_chi2,        ///< of the pixel itself
  time_unchanged,   ///< 1 where no test shows a change, else 0
  time_share,       ///< of the past that stays around a pixel, in its row
  time_difference,  ///< in standard deviations, one plane a measurement
};

/// A test by chi^2, as ChangeTest.
struct TimeTest {
  float certain, most;
};

/// As TimeFilter::State.
struct TimeParameters {
  int height, width;
  int cell_rows, cell_columns;

  int gain, dark_raw, floor_variance_e2, shot_per_signal;  ///< of every measurement
  int to_plane;  ///< (RANK, K), times the gain
  float lowest, highest;  ///< as SaturationLevels
  int has_own_shot_noise;
  float hidden_floor_e2, hidden_shot_per_signal, mean_curve_square;  ///< as HiddenSignal
  struct TimeTest pixel, patch, shared;
  float max_weight;  ///< of the past, of one measurement
  float none;        ///< the weight of pixels that are not usable
  float telling_share;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
