// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Parameters of the temporal filter's kernels, shared by C++ and OpenCL C as in
// decode_parameters.h.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

/// Planes (H, W) that compare a frame with the running mean.
enum TimePlane {
  time_usable,      ///< 1 if frame and mean are both usable, else 0
  time_chi2,        ///< of the pixel itself
  time_unchanged,   ///< 1 if no test detects a change, else 0
  time_share,       ///< smallest remaining share of the past along the row around a pixel
  time_difference,  ///< in standard deviations, one plane per measurement
};

/// A chi^2 test, see ChangeTest.
struct TimeTest {
  float certain, most;
};

/// See TimeFilter::State.
struct TimeParameters {
  int height, width;
  int cell_rows, cell_columns;

  int gain, dark_raw, floor_variance_e2, shot_per_signal;  ///< per measurement
  int to_plane;  ///< (RANK, K), includes the gain
  float lowest, highest;  ///< see SaturationLevels
  int has_own_shot_noise;
  float hidden_floor_e2, hidden_shot_per_signal, mean_curve_square;  ///< see HiddenSignal
  struct TimeTest pixel, patch, shared;
  float max_weight;  ///< of the past, relative to one measurement
  float none;        ///< weight of unusable pixels
  float telling_share;
};

#ifdef __cplusplus
}  // namespace tofsmith
#endif
