// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "calibrate/delay_groups.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"

namespace tofsmith {

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
