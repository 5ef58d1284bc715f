// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "calibrate/delay_groups.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
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

inline constexpr std::size_t enough_pixels = 8;  ///< to take noise from

/// All frames of one pixel (F, K).
Eigen::MatrixXd pixel_values(const RawFrames& raw, std::size_t pixel);

/// Pixels that can be used; the others are counted by why they cannot.
/// @throws std::invalid_argument if there is none
std::vector<std::size_t> live_pixels(const DelaySweep& sweep,
                                     const CorrelationCalibrationOptions& options,
                                     DeadPixels& dead);

/// Mean of those pixels (F, K).
Eigen::MatrixXd mean_curve(const RawFrames& raw, const std::vector<std::size_t>& live);

/// Size of the part of a curve that changes with delay.
double swing(const Eigen::MatrixXd& curve);

/// Variance of the mean curve, from how differently pixels change between two frames of one delay;
/// 0 if there are none or too few pixels.
double mean_curve_variance(const RawFrames& raw, const DelayGroups& groups,
                           const std::vector<std::size_t>& live);

}  // namespace tofsmith
