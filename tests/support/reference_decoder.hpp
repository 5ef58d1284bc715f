// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "core/shared/periodic.hpp"
#include "decode/search/smooth_curve.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Direct implementation of the decoder's definition: all bins of one pixel, in double, in
/// measurement space. All faster implementations are compared with it.
class ReferenceDecoder {
 public:
  explicit ReferenceDecoder(const DecodingTable& table) : table_(table) {
    const Eigen::VectorXd a = table.exposure_s.cwiseProduct(table.ambient_gain);
    ambient_ = a.norm() > 1e-9 * table.exposure_s.norm() ? Eigen::VectorXd(a / a.norm())
                                                         : Eigen::VectorXd::Zero(a.size());
    curve_.resize(table.measurements(), table.samples());
    for (int n = 0; n < table.samples(); ++n)
      curve_.col(n) =
          without_ambient(table.correlation.row(n).transpose().cwiseProduct(table.exposure_s));
    if (depth_polynomials(AmbientProjection(table).curve)) {
      Eigen::VectorXcd one;
      for (int k = 0; k < table.measurements(); ++k) {
        PeriodicTransform(table.samples()).forward(curve_.row(k).transpose(), one);
        if (k == 0) spectrum_.resize(one.size(), table.measurements());
        spectrum_.col(k) = one / table.samples();
      }
    }
    length_ = curve_.colwise().norm();
    for (double& length : length_)
      if (length <= 1e-9 * length_.maxCoeff()) length = 0.0;
  }

  /// P y' of a pixel's raw values.
  template <typename Number>
  Eigen::VectorXd difference(const Number* raw) const {
    Eigen::VectorXd y(table_.measurements());
    for (int k = 0; k < y.size(); ++k)
      y[k] = (static_cast<double>(raw[k]) - table_.black_level[k]) * table_.gain_e_per_raw[k] -
             table_.dark_electrons[k];
    const Eigen::VectorXd left = without_ambient(y);
    return left.norm() > 1e-12 * y.lpNorm<1>() ? left : Eigen::VectorXd::Zero(y.size());
  }

  double score(const Eigen::VectorXd& difference, int bin) const {
    return length_[bin] > 0.0 ? difference.dot(curve_.col(bin)) / length_[bin]
                              : -std::numeric_limits<double>::infinity();
  }

  template <typename Number>
  int bin(const Number* raw) const {
    return table_.nearest_bin(row(raw));
  }

  template <typename Number>
  int row(const Number* raw) const {
    const Eigen::VectorXd left = difference(raw);
    double best = -std::numeric_limits<double>::infinity();
    for (int n = 0; n < table_.samples(); ++n) best = std::max(best, score(left, n));
    int n = 0;
    while (!(score(left, n) >= best - 1e-11 * left.norm())) ++n;
    return n;
  }

  /// Score at any depth: by trigonometric interpolation of smooth tables, else on chords.
  double score_at(const Eigen::VectorXd& difference, double depth_bin) const {
    if (spectrum_.size() > 0) {
      const Eigen::VectorXd smooth_point = on_smooth_curve(depth_bin);
      return difference.dot(smooth_point) / smooth_point.norm();
    }
    const int from = static_cast<int>(depth_bin), to = (from + 1) % table_.samples();
    const double t = depth_bin - from;
    const Eigen::VectorXd point = (1 - t) * curve_.col(from) + t * curve_.col(to);
    return difference.dot(point) / point.norm();
  }

  /// Best score on the two chords at a bin, by golden-section search.
  double best_score_beside(const Eigen::VectorXd& difference, int bin) const {
    double best = score(difference, bin);
    const int left = (bin + table_.samples() - 1) % table_.samples();
    for (const int from : {bin, left}) {
      double low = from, high = from + 1.0;
      const double golden = (std::sqrt(5.0) - 1) / 2;
      for (int i = 0; i < 60; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        score_at(difference, a) < score_at(difference, b) ? low = a : high = b;
      }
      best = std::max(best, score_at(difference, low));
    }
    return best;
  }

 private:
  Eigen::VectorXd on_smooth_curve(double depth_bin) const {
    const double turn = 2.0 * std::numbers::pi * depth_bin / table_.samples();
    Eigen::VectorXd point = spectrum_.row(0).real().transpose();
    const Eigen::Index half = table_.samples() / 2;
    for (Eigen::Index n = 1; n < spectrum_.rows(); ++n) {
      const bool is_last = n == half && table_.samples() % 2 == 0;
      const std::complex<double> at =
          std::polar(is_last ? 1.0 : 2.0, static_cast<double>(n) * turn);
      point += (spectrum_.row(n) * at).real().transpose();
    }
    return point;
  }
  Eigen::VectorXd without_ambient(const Eigen::VectorXd& y) const {
    return y - ambient_.dot(y) * ambient_;
  }

  DecodingTable table_;
  Eigen::VectorXd ambient_;    // unit vector, or zero
  Eigen::MatrixXd curve_;      // P x (K, N)
  Eigen::MatrixXcd spectrum_;  // of a smooth table (N / 2 + 1, K); else empty
  Eigen::VectorXd length_;     // |P x| (N), 0 without contrast
};

}  // namespace tofsmith
