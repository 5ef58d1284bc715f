// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/sweep_drift.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace tofsmith {
namespace {

/// What is left of x (F, K) without the means of its groups.
Eigen::MatrixXd within_groups(const Eigen::MatrixXd& x, const DelayGroups& groups) {
  const Eigen::MatrixXd means = group_means(x, groups);
  Eigen::MatrixXd rest = x;
  for (Eigen::Index f = 0; f < x.rows(); ++f)
    rest.row(f) -= means.row(groups.group_of_frame[static_cast<std::size_t>(f)]);
  return rest;
}

}  // namespace

double sweep_time(int frame, int frames) {
  return frames > 1 ? static_cast<double>(frame) / (frames - 1) - 0.5 : 0.0;
}

Eigen::MatrixXd group_means(const Eigen::MatrixXd& curve, const DelayGroups& groups) {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(groups.count(), curve.cols());
  for (Eigen::Index f = 0; f < curve.rows(); ++f)
    means.row(groups.group_of_frame[static_cast<std::size_t>(f)]) += curve.row(f);
  for (Eigen::Index g = 0; g < means.rows(); ++g)
    means.row(g) /= groups.repeats[static_cast<std::size_t>(g)];
  return means;
}

SweepDrift sweep_drift(const Eigen::MatrixXd& curve, const DelayGroups& groups,
                       double noise_variance) {
  SweepDrift drift;
  const Eigen::Index frames = curve.rows(), columns = curve.cols();
  drift.correction = Eigen::MatrixXd::Zero(frames, columns);
  if (!groups.has_repeats()) return drift;

  Eigen::MatrixXd light_shape(frames, columns), level_shape(frames, columns);
  Eigen::MatrixXd corrected = curve;
  Eigen::Vector2d change = Eigen::Vector2d::Zero();
  Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();
  double left = 0.0;
  for (int round = 0; round < 4; ++round) {
    Eigen::MatrixXd signal = group_means(corrected, groups);
    signal.rowwise() -= signal.colwise().mean().eval();
    for (Eigen::Index f = 0; f < frames; ++f) {
      const double t = sweep_time(static_cast<int>(f), static_cast<int>(frames));
      light_shape.row(f) = t * signal.row(groups.group_of_frame[static_cast<std::size_t>(f)]);
      level_shape.row(f).setConstant(t);
    }
    Eigen::MatrixXd shapes(curve.size(), 2);
    const Eigen::MatrixXd light = within_groups(light_shape, groups);
    const Eigen::MatrixXd level = within_groups(level_shape, groups);
    const Eigen::MatrixXd seen = within_groups(curve, groups);
    shapes << light.reshaped(), level.reshaped();
    inverse = (shapes.transpose() * shapes).inverse();
    if (!inverse.allFinite()) return drift;
    change = inverse * (shapes.transpose() * seen.reshaped());
    left = (seen.reshaped() - shapes * change).squaredNorm();
    corrected = curve - change[0] * light_shape - change[1] * level_shape;
  }
  const auto repeated = static_cast<double>((frames - groups.count()) * columns);
  if (noise_variance == 0.0) {
    constexpr double fewest = 3.0;  // values beyond what the two changes use
    if (repeated < 2 + fewest) return drift;
    noise_variance = left / (repeated - 2);
  }
  drift.known = true;
  drift.light = {change[0], std::sqrt(noise_variance * inverse(0, 0))};
  drift.level = {change[1], std::sqrt(noise_variance * inverse(1, 1))};
  drift.significant = std::abs(drift.light.value) > 3 * drift.light.standard_error ||
                      std::abs(drift.level.value) > 3 * drift.level.standard_error;
  if (drift.significant) drift.correction = change[0] * light_shape + change[1] * level_shape;
  return drift;
}

}  // namespace tofsmith
