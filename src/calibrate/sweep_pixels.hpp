// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

struct DelayGroups {
  std::vector<double> place;  ///< in [0, 1), increasing (G)
  std::vector<int> group_of_frame;
  std::vector<int> repeats;  ///< frames (G)
  double span_periods = 0.0;
  bool equal_steps = false;  ///< positions are equally spaced over the period
  bool from_zero = false;    ///< positions are the rows of a table with N = G

  int count() const { return static_cast<int>(place.size()); }
  bool has_repeats() const { return place.size() < group_of_frame.size(); }
};

/// Groups delays that differ by less than 2 % of the usual step, modulo the period.
DelayGroups delay_groups(const std::vector<double>& delay_periods);

/// @throws std::invalid_argument naming the missing part of the period
void require_whole_period(const DelayGroups& groups);

struct SweepDrift {
  bool known = false;  ///< repeated delays determine it, with errors
  bool significant = false;
  Estimate light;              ///< relative change over the sweep
  Estimate level;              ///< change over the sweep [DN]
  Eigen::MatrixXd correction;  ///< to subtract (F, K)
};

/// Scaled to [-1/2, 1/2].
double sweep_time(int frame, int frames);

/// Means over the frames of each group (G, K).
Eigen::MatrixXd group_means(const Eigen::MatrixXd& curve, const DelayGroups& groups);
/// Residual of x (F, K) about its group means.
Eigen::MatrixXd within_groups(const Eigen::MatrixXd& x, const DelayGroups& groups);

/// Least squares fit to the differences within groups.
/// @param curve           mean over pixels (F, K)
/// @param noise_variance  of its values, if known; 0: from the residual of the fit
SweepDrift sweep_drift(const Eigen::MatrixXd& curve, const DelayGroups& groups,
                       double noise_variance);

inline constexpr std::size_t enough_pixels = 8;  ///< to estimate noise

Eigen::MatrixXd pixel_values(const RawFrames& raw, std::size_t pixel);

/// Returns usable pixels and counts the others by reason. @throws std::invalid_argument if there is
/// none
std::vector<std::size_t> live_pixels(const DelaySweep& sweep,
                                     const CorrelationCalibrationOptions& options,
                                     DeadPixels& dead);

Eigen::MatrixXd mean_curve(const RawFrames& raw, const std::vector<std::size_t>& live);

/// Size of the part of a curve that depends on delay.
double swing(const Eigen::MatrixXd& curve);

/// Variance of the mean curve, from differences between pixels in their change between two frames
/// of one delay; 0 without such frames or with too few pixels.
double mean_curve_variance(const RawFrames& raw, const DelayGroups& groups,
                           const std::vector<std::size_t>& live);

/// Pixels relative to a common curve: c_p = gain_p advanced(C, delay_p).
struct PixelAlignment {
  std::vector<double> delay_periods;  ///< excess depth; mean 0
  std::vector<double> gain;           ///< mean 1
  Eigen::MatrixXcd common;            ///< C (H + 1, K)
};

/// Maximum over shift [periods] of Re sum_n s_n exp(-2 pi i n shift); s_0 is ignored.
struct BestShift {
  double shift = 0.0;
  double value = 0.0;
};
BestShift best_shift(const Eigen::VectorXcd& s);

/// Alternates between pixels and their common curve until delays change by less than 1e-9 periods.
/// @param pixels  c of each pixel (H + 1, K)
PixelAlignment align_pixels(const std::vector<Eigen::MatrixXcf>& pixels, const Progress& progress);

}  // namespace tofsmith
