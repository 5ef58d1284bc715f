// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "calibrate/delay_groups.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

/// Straight-line change of light and level over a sweep.
struct SweepDrift {
  bool known = false;  ///< repeats tell it, with errors
  bool significant = false;
  Estimate light;              ///< share, from the first to the last frame
  Estimate level;              ///< raw numbers, from the first to the last frame
  Eigen::MatrixXd correction;  ///< to take off the mean curve (F, K)
};

/// Time of frame f, from -1/2 to 1/2.
double sweep_time(int frame, int frames);

/// Mean of the frames of each group (G, K).
Eigen::MatrixXd group_means(const Eigen::MatrixXd& curve, const DelayGroups& groups);

/// Least squares of light and level against the differences within groups.
/// @param curve           mean over pixels (F, K)
/// @param noise_variance  of its values, if pixels tell it; 0: from what the fit leaves
SweepDrift sweep_drift(const Eigen::MatrixXd& curve, const DelayGroups& groups,
                       double noise_variance);

}  // namespace tofsmith
