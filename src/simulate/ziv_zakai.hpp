// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Ratio of mean absolute value to standard deviation of a normal deviation.
inline double mae_per_sigma() { return std::sqrt(2.0 / std::numbers::pi); }

/// Ziv-Zakai bound on the mean circular error, in periods, of any estimator of a delay that is
/// uniform over the period and observed with normal noise:
///   mean |error| >= integral over 0 < h < 1/2 of the mean over u of P(u, u + h),
/// with P the smallest probability of confusing two equally likely delays.
///
/// By convexity P >= Q(root of the mean squared distance / 2). The mean squared distance of delays
/// h apart, in standard deviations, is at most the smaller of
///   sum over n of w_n power_n 4 sin^2(pi n h), with any shares w_n >= 0 that add to at most 1,
///   h^2 information.
/// The result is a lower limit for the minimum over all shares.
/// @param power  power_n of harmonics 1 to size, >= 0; empty: only the information is used
/// @param information  mean over delays [1 / period^2], >= 0 or infinity
/// @see docs/bounds.md; J. Ziv, M. Zakai, IEEE Trans. Inf. Theory 15 (1969) 386
double ziv_zakai_mae(const Eigen::VectorXd& power, double information);

/// Error [m]: the Ziv-Zakai bound if depths are uniform, else range sqrt(2 / pi) /
/// sqrt(information).
/// @param max_density  of depths, relative to uniform
inline double mae_of_information_m(double information, double range_m, double max_density) {
  return range_m * (max_density > 1.0 ? mae_per_sigma() / std::sqrt(information)
                                      : ziv_zakai_mae(Eigen::VectorXd(), information));
}

}  // namespace tofsmith
