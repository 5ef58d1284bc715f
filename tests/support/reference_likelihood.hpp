// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Direct implementation of a pixel's likelihood, evaluated independently at each depth.
class ReferenceLikelihood {
 public:
  explicit ReferenceLikelihood(const DecodingTable& table)
      : table_(table),
        shot_(table.shot()),
        shot_ambient_gain_(table.shot_ambient()),
        floor_(table.constant_variance_e2 + table.shot_dark()) {
    const Eigen::VectorXd a = table.exposure_s.cwiseProduct(table.ambient_gain);
    sees_ambient_ = a.norm() > 1e-9 * table.exposure_s.norm();
  }

  bool sees_ambient() const { return sees_ambient_; }

  Eigen::VectorXd electrons(const float* raw) const {
    Eigen::VectorXd y(table_.measurements());
    for (int k = 0; k < y.size(); ++k)
      y[k] = (raw[k] - table_.black_level[k]) * table_.gain_e_per_raw[k] - table_.dark_electrons[k];
    return y;
  }

  /// sum (y - mu)^2 / v + log v.
  double cost(const Eigen::VectorXd& y, double depth_bin, double signal, double ambient) const {
    const Eigen::VectorXd mean = signal * seen(depth_bin) + ambient * seen_ambient();
    const Eigen::ArrayXd v = variance(y, depth_bin, signal, ambient).array();
    return ((y - mean).array().square() / v + v.log()).sum();
  }

  /// Minimum over a grid of depths and over all iterations of a reweighted least-squares fit of the
  /// light.
  double min_cost(const Eigen::VectorXd& y, int depths_per_bin) const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < table_.samples() * depths_per_bin; ++i) {
      const double depth_bin = static_cast<double>(i) / depths_per_bin;
      Eigen::VectorXd v = Eigen::VectorXd::Constant(y.size(), y.cwiseAbs().mean() + 1.0);
      for (int step = 0; step < 4; ++step) {
        const Eigen::Vector2d light = weighted_fit(y, depth_bin, v);
        least = std::min(least, cost(y, depth_bin, light[0], light[1]));
        v = variance(y, depth_bin, light[0], light[1]);
      }
    }
    return least;
  }

 private:
  Eigen::VectorXd at(const Eigen::MatrixXd& table, double depth_bin) const {
    const int from = static_cast<int>(depth_bin) % table_.samples();
    const int to = (from + 1) % table_.samples();
    const double t = depth_bin - std::floor(depth_bin);
    return ((1 - t) * table.row(from) + t * table.row(to)).transpose();
  }
  Eigen::VectorXd seen(double depth_bin) const {
    return at(table_.correlation, depth_bin).cwiseProduct(table_.exposure_s);
  }
  Eigen::VectorXd seen_ambient() const {
    return table_.exposure_s.cwiseProduct(table_.ambient_gain);
  }
  Eigen::VectorXd variance(const Eigen::VectorXd& y, double depth_bin, double signal,
                           double ambient) const {
    const Eigen::VectorXd light = signal * at(shot_, depth_bin) + ambient * shot_ambient_gain_;
    return (light.cwiseProduct(table_.exposure_s) + floor_).cwiseMax(1e-4 * y.cwiseAbs().mean());
  }
  /// Signal and ambient light, both >= 0.
  Eigen::Vector2d weighted_fit(const Eigen::VectorXd& y, double depth_bin,
                               const Eigen::VectorXd& v) const {
    const Eigen::VectorXd weight = v.cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd light(y.size(), 2);
    light << seen(depth_bin), seen_ambient();
    const Eigen::MatrixXd whitened = weight.asDiagonal() * light;
    const Eigen::VectorXd target = weight.cwiseProduct(y);
    const auto alone = [&](int column) {
      const double length2 = whitened.col(column).squaredNorm();
      return length2 > 0.0 ? std::max(0.0, whitened.col(column).dot(target) / length2) : 0.0;
    };
    const Eigen::Vector2d only_signal(alone(0), 0.0), only_ambient(0.0, alone(1));
    if (!sees_ambient_) return only_signal;
    const Eigen::Vector2d both = whitened.colPivHouseholderQr().solve(target);
    if (both.allFinite() && both.minCoeff() >= 0.0) return both;
    const double left_by_signal = (target - whitened * only_signal).squaredNorm();
    const double left_by_ambient = (target - whitened * only_ambient).squaredNorm();
    return left_by_signal <= left_by_ambient ? only_signal : only_ambient;
  }

  DecodingTable table_;
  Eigen::MatrixXd shot_;
  Eigen::VectorXd shot_ambient_gain_, floor_;
  bool sees_ambient_ = true;
};

}  // namespace tofsmith
