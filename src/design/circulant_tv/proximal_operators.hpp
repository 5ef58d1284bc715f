// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tofsmith {

/// Proximal maps of total variation, x = argmin 1/2 |x - y|^2 + weight TV(x), by dynamic
/// programming over the knots of the derivative of the cost-to-go: O(N). Not thread-safe: keeps
/// buffers.
/// @see Johnson, "A dynamic programming algorithm for the fused lasso and L0-segmentation", 2013
class TotalVariationProx {
 public:
  /// Open chain: TV(x) = sum_{n < N - 1} |x[n + 1] - x[n]|, weight >= 0.
  void linear(const Eigen::VectorXd& y, double weight, Eigen::VectorXd& x);

  /// Closed ring. The dual variable u of the jump from the last to the first sample is added to the
  /// ends of an open chain with opposite signs; x[0] - x[N - 1] decreases with u.
  /// @param ring_dual  initial and final u, a good start for a similar y
  void circular(const Eigen::VectorXd& y, double weight, double& ring_dual, Eigen::VectorXd& x);

 private:
  double ring_gap(const Eigen::VectorXd& y, double weight, double dual, Eigen::VectorXd& x);

  struct Knot {
    double position, slope_change, offset_change;
  };
  std::vector<Knot> knots_;
  std::vector<double> lower_, upper_;  // clips of x[n], given x[n + 1]
  Eigen::VectorXd tilted_;
};

/// Projects `x` in place onto { 0 <= x <= upper_bound, sum x <= budget }:
///   x <- clip(x - price, 0, upper_bound) with the smallest price >= 0 that meets the budget.
/// @return the price; 0 if the budget is inactive
double project_on_box_and_budget(Eigen::VectorXd& x, double upper_bound,
                                 const std::optional<double>& budget);

}  // namespace tofsmith
