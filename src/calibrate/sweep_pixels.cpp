// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "calibrate/sweep_pixels.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// Residual of x (F, K) about its group means.
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
    constexpr double min_values = 3.0;  // in addition to the two fitted changes
    if (repeated < 2 + min_values) return drift;
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

Eigen::MatrixXd pixel_values(const RawFrames& raw, std::size_t pixel) {
  Eigen::MatrixXd values(raw.frames, raw.measurements);
  const auto stride = static_cast<std::size_t>(raw.measurements);
  for (int f = 0; f < raw.frames; ++f)
    for (int k = 0; k < raw.measurements; ++k)
      values(f, k) = raw.frame(f)[pixel * stride + static_cast<std::size_t>(k)];
  return values;
}

std::vector<std::size_t> live_pixels(const DelaySweep& sweep,
                                     const CorrelationCalibrationOptions& options,
                                     DeadPixels& dead) {
  std::vector<std::size_t> live;
  for (std::size_t p = 0; p < sweep.frames.pixels_per_frame(); ++p) {
    const Eigen::MatrixXd values = pixel_values(sweep.frames, p);
    if (!values.allFinite())
      ++dead.not_a_number;
    else if ((values.rowwise() - values.row(0)).isZero(0.0))
      ++dead.constant;
    else if (options.saturation_level &&
             values.maxCoeff() >= static_cast<double>(*options.saturation_level))
      ++dead.saturated;
    else
      live.push_back(p);
  }
  require(!live.empty(), "live pixels", 0,
          fmt::format("must be >= 1: {} not a number, {} constant, {} saturated", dead.not_a_number,
                      dead.constant, dead.saturated));
  return live;
}

Eigen::MatrixXd mean_curve(const RawFrames& raw, const std::vector<std::size_t>& live) {
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(raw.frames, raw.measurements);
  for (const std::size_t p : live) mean += pixel_values(raw, p);
  return mean / static_cast<double>(live.size());
}

double swing(const Eigen::MatrixXd& curve) {
  return (curve.rowwise() - curve.colwise().mean()).norm();
}

double mean_curve_variance(const RawFrames& raw, const DelayGroups& groups,
                           const std::vector<std::size_t>& live) {
  if (live.size() < enough_pixels) return 0.0;
  for (int f = 0; f < raw.frames; ++f)
    for (int other = f + 1; other < raw.frames; ++other) {
      if (groups.group_of_frame[static_cast<std::size_t>(f)] !=
          groups.group_of_frame[static_cast<std::size_t>(other)])
        continue;
      double sum = 0.0;
      for (int k = 0; k < raw.measurements; ++k) {
        RunningStatistics difference;
        for (const std::size_t p : live) {
          const std::size_t i =
              p * static_cast<std::size_t>(raw.measurements) + static_cast<std::size_t>(k);
          difference.add(static_cast<double>(raw.frame(f)[i]) -
                         static_cast<double>(raw.frame(other)[i]));
        }
        sum += 0.5 * difference.variance();
      }
      return sum / raw.measurements / static_cast<double>(live.size());
    }
  return 0.0;
}

}  // namespace tofsmith
