// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// How often depths occur (OperatingRange::depths within its working_distance_m), over depth as a
/// share of the unambiguous range in [0, 1): constant within equal parts of an interval.
class DepthPrior {
 public:
  /// @param weights     of equal parts of the interval, checked; none, or all the same: all of its
  ///                    depths alike
  /// @param begin, end  of the interval, 0 <= begin < end <= 1
  explicit DepthPrior(const std::vector<double>& weights, double begin = 0.0, double end = 1.0);
  /// That of a camera that is valid.
  explicit DepthPrior(const Camera& camera);
  DepthPrior() = default;  ///< all depths alike

  /// Whether weights say no more than that all depths are alike.
  static bool are_alike(const std::vector<double>& weights);

  bool is_uniform() const { return mass_.empty(); }
  /// Over that of uniform depths, whose is 1. At 1, that of the last depths.
  double density(double share) const;
  double max_density() const;
  /// Share of depths below.
  double below(double share) const;
  /// Depth below which so many lie, `part` in [0, 1); part itself where all depths are alike.
  double quantile(double part) const;
  // The interval, and of its parts what share of depths lies in each, and below each and 1; none
  // where all depths are alike.
  double begin() const { return begin_; }
  double end() const { return end_; }
  const std::vector<double>& part_masses() const { return mass_; }
  const std::vector<double>& below_parts() const { return below_; }

  /// Share of depths in each of so many equal parts of the range; none: all depths are alike.
  Eigen::VectorXd masses(Eigen::Index parts) const;

 private:
  std::size_t cell_of(double share) const;
  double begin_of(std::size_t cell) const;

  double begin_ = 0.0, end_ = 1.0;
  std::vector<double> mass_;   // of each part
  std::vector<double> below_;  // each part, and 1
};

/// Mean of values of equal parts of the range; those of depths that never occur may be infinite.
/// @param masses  DepthPrior::masses() of as many
double mean_over_depths(const Eigen::VectorXd& values, const Eigen::VectorXd& masses);

}  // namespace tofsmith
