// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// The decoder's definition, read aloud: all bins of one pixel, in double, in the space of the
/// measurements. Every faster way is held against it.
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
    length_ = curve_.colwise().norm();
    for (double& length : length_)
      if (length <= 1e-9 * length_.maxCoeff()) length = 0.0;
  }

  /// P y' of a pixel's raw numbers.
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
    const Eigen::VectorXd left = difference(raw);
    double best = -std::numeric_limits<double>::infinity();
    for (int n = 0; n < table_.samples(); ++n) best = std::max(best, score(left, n));
    int n = 0;
    while (!(score(left, n) >= best - 1e-11 * left.norm())) ++n;
    return n;
  }

  /// Score at any depth, on the chords between bins.
  double score_at(const Eigen::VectorXd& difference, double depth_bin) const {
    const int from = static_cast<int>(depth_bin), to = (from + 1) % table_.samples();
    const double t = depth_bin - from;
    const Eigen::VectorXd point = (1 - t) * curve_.col(from) + t * curve_.col(to);
    return difference.dot(point) / point.norm();
  }

  /// The best score on the chords beside a bin, by golden section.
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
  Eigen::VectorXd without_ambient(const Eigen::VectorXd& y) const {
    return y - ambient_.dot(y) * ambient_;
  }

  DecodingTable table_;
  Eigen::VectorXd ambient_;  // unit, or zero
  Eigen::MatrixXd curve_;    // P x (K, N)
  Eigen::VectorXd length_;   // |P x| (N), 0 without contrast
};

}  // namespace tofsmith
