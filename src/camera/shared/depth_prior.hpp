// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Prior distribution of depths (OperatingRange::depths within working_distance_m) as fractions of
/// the range in [0, 1), with constant density within equal parts of an interval.
class DepthPrior {
 public:
  /// @param weights     one per equal part of the interval, validated; empty or all equal: uniform
  /// @param begin, end  0 <= begin < end <= 1
  explicit DepthPrior(const std::vector<double>& weights, double begin = 0.0, double end = 1.0);
  explicit DepthPrior(const Camera& camera);
  DepthPrior() = default;  ///< uniform over the whole range

  static bool are_alike(const std::vector<double>& weights);

  bool is_uniform() const { return mass_.empty(); }
  /// Relative to uniform depths. At share = 1, of the last depths.
  double density(double share) const;
  double max_density() const;
  double below(double share) const;
  /// Quantile for `part` in [0, 1).
  double quantile(double part) const;

  /// Probability of `parts` equal parts of the range; empty if uniform.
  Eigen::VectorXd masses(Eigen::Index parts) const;

 private:
  std::size_t cell_of(double share) const;
  double begin_of(std::size_t cell) const;

  double begin_ = 0.0, end_ = 1.0;
  // Empty if uniform.
  std::vector<double> mass_;   // of each part
  std::vector<double> below_;  // and 1
};

/// Mean over equal parts of the range. Values of parts with probability 0 may be infinite.
/// @param masses  DepthPrior::masses() for the same parts
double mean_over_depths(const Eigen::VectorXd& values, const Eigen::VectorXd& masses);

}  // namespace tofsmith
