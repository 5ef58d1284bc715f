// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "decode/ambient_projection.hpp"
#include "decode/output/lobe_posterior.hpp"
#include "decode/search/chord_matcher.hpp"
#include "decode/search/smooth_curve.hpp"

namespace tofsmith {

/// Returns ln of the integral of exp(c t - t^2 / 2) / t dt from 0.1 to infinity, by the trapezoidal
/// rule over ln t or, for large c, by its asymptotic series.
inline double reference_log_density(double c) {
  if (c > 20.0)
    return 0.5 * c * c + std::log(std::sqrt(2 * std::numbers::pi) / c * (1.0 + 1.0 / (c * c)));
  constexpr int steps = 600;
  const double from = std::log(0.1), to = std::log(std::max(c, 0.0) + 9.0);
  const double step = (to - from) / steps;
  const auto exponent = [c](double t) { return c * t - 0.5 * t * t; };
  const double largest = exponent(std::max(c, 0.1));
  double sum = 0.0;
  for (int i = 0; i <= steps; ++i)
    sum += (i == 0 || i == steps ? 0.5 : 1.0) *
           std::exp(exponent(std::exp(from + i * step)) - largest);
  return largest + std::log(sum * step);
}

/// Returns the posterior probability of the main lobe according to its definition, in double,
/// sampled at `parts` points per row on the chords; a smooth curve is first interpolated to twice
/// the number of rows.
/// @param q            measurement after projection (rank)
/// @param variance_e2  (K)
inline double reference_posterior(const AmbientProjection& projection, const MainLobe& lobe,
                                  const Eigen::VectorXd& q, const Eigen::VectorXd& variance_e2,
                                  std::int32_t row, int parts) {
  const Eigen::MatrixXd& v = projection.noise_basis;
  const Eigen::LLT<Eigen::MatrixXd> covariance(v.transpose() * variance_e2.asDiagonal() * v);
  const Eigen::VectorXd white = covariance.matrixL().solve(q);
  const int finer = depth_polynomials(projection.curve) ? 2 : 1;
  const RowMajorMatrix curve =
      finer > 1 ? RowMajorMatrix(interpolated(projection.curve, finer)) : projection.curve;
  const Eigen::VectorXd turn_rad = turns_of(curve);
  const auto samples = static_cast<std::int32_t>(curve.rows());
  std::vector<double> log_density, away;
  for (std::int32_t n = 0; n < samples; ++n)
    for (int part = 0; part < parts; ++part) {
      double t = (part + 0.5) / parts;
      if (turn_rad[n] > jump_turn_rad) t = t < 0.5 ? 0.0 : 1.0;
      const Eigen::VectorXd point =
          (1 - t) * curve.row(n).transpose() + t * curve.row((n + 1) % samples).transpose();
      const Eigen::VectorXd direction = covariance.matrixL().solve(point);
      const double length = direction.norm();
      log_density.push_back(
          reference_log_density(length > 0.0 ? white.dot(direction) / length : 0.0));
      away.push_back(std::remainder((n + (part + 0.5) / parts) / finer - row, samples / finer));
    }
  const double largest = *std::max_element(log_density.begin(), log_density.end());
  double inside = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < away.size(); ++i) {
    const double mass = std::exp(log_density[i] - largest);
    whole += mass;
    if (away[i] >= -lobe.left && away[i] <= lobe.right) inside += mass;
  }
  return inside / whole;
}

}  // namespace tofsmith
