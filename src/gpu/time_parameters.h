// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Parameters of the temporal filter's kernels, see decode_parameters.h.
#ifdef __cplusplus
#pragma once
namespace tofsmith {
#endif

enum TimePlane {
  time_usable,      ///< 1 if both are usable, else 0
  time_chi2,        ///< of a pixel
  time_unchanged,   ///< 1 if no test detects a change
  time_share,       ///< smallest remaining share of the past in the row
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
