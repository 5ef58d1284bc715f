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

/// Removes harmonics that are rounding errors in the response's second derivative, but keeps enough
/// of them to sample results.
inline Eigen::VectorXcd without_rounding(const Eigen::VectorXcd& transfer) {
  constexpr Eigen::Index least_kept = 256;
  constexpr double rounding = 1e-7;  // relative to the largest
  const Eigen::ArrayXd curvature =
      Eigen::ArrayXd::LinSpaced(transfer.size(), 0.0, static_cast<double>(transfer.size() - 1))
          .square() *
      transfer.array().abs();
  const double least = rounding * curvature.maxCoeff();
  Eigen::Index kept = transfer.size();
  while (kept > least_kept + 1 && curvature[kept - 1] <= least) --kept;
  return transfer.head(kept);
}

/// Mean over albedo uniform in (0, 1) of min(mae(albedo), largest). Nodes are denser near albedo 0,
/// where the error grows.
template <typename Mae>
double mean_over_albedo(double largest, Mae&& mae) {
  constexpr int nodes = 48;
  double sum = 0.0;
  for (int i = 0; i < nodes; ++i) {
    const double x = (i + 0.5) / nodes;  // albedo = x^2, d albedo = 2 x dx
    sum += 2.0 * x * std::min(largest, mae(x * x));
  }
  return sum / nodes;
}

inline OperatingPoint dimmed(const OperatingPoint& point, double albedo) {
  return {albedo * point.signal_e_per_s, point.ambient_e_per_s};
}

}  // namespace tofsmith
