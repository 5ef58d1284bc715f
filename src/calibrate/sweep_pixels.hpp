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

/// Linear drift of light and level during a sweep.
struct SweepDrift {
  bool known = false;  ///< the sweep has repeated delays that determine it, with errors
  bool significant = false;
  Estimate light;              ///< relative change from the first to the last frame
  Estimate level;              ///< change of raw numbers from the first to the last frame
  Eigen::MatrixXd correction;  ///< to subtract from the mean curve (F, K)
};

/// Returns the time of a frame, scaled to [-1/2, 1/2].
double sweep_time(int frame, int frames);

/// Returns the mean of the frames of each group (G, K).
Eigen::MatrixXd group_means(const Eigen::MatrixXd& curve, const DelayGroups& groups);

/// Fits light and level to the differences within groups by least squares.
/// @param curve           mean over pixels (F, K)
/// @param noise_variance  of its values, if pixels determine it; 0: from the residual of the fit
SweepDrift sweep_drift(const Eigen::MatrixXd& curve, const DelayGroups& groups,
                       double noise_variance);

inline constexpr std::size_t enough_pixels = 8;  ///< minimum to estimate noise from pixels

Eigen::MatrixXd pixel_values(const RawFrames& raw, std::size_t pixel);

/// Returns the usable pixels and counts the others by reason.
/// @throws std::invalid_argument if there is none
std::vector<std::size_t> live_pixels(const DelaySweep& sweep,
                                     const CorrelationCalibrationOptions& options,
                                     DeadPixels& dead);

Eigen::MatrixXd mean_curve(const RawFrames& raw, const std::vector<std::size_t>& live);

/// Returns the size of the part of a curve that depends on delay.
double swing(const Eigen::MatrixXd& curve);

/// Returns the variance of the mean curve, from differences between pixels in their change between
/// two frames of one delay; 0 without such frames or with too few pixels.
double mean_curve_variance(const RawFrames& raw, const DelayGroups& groups,
                           const std::vector<std::size_t>& live);

}  // namespace tofsmith
