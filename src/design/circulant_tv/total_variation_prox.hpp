// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tofsmith {

/// Proximal maps of total variation, x = argmin 1/2 |x - y|^2 + weight TV(x), by dynamic
/// programming over the knots of the derivative of the cost-to-go: O(N) whatever the data.
/// Keeps its buffers between calls; an object serves one thread at a time.
/// @see Johnson, "A dynamic programming algorithm for the fused lasso and L0-segmentation", 2013
class TotalVariationProx {
 public:
  /// Open chain: TV(x) = sum_{n < N - 1} |x[n + 1] - x[n]|.
  /// @param weight  >= 0
  void linear(const Eigen::VectorXd& y, double weight, Eigen::VectorXd& x);

  /// Closed ring: the jump from the last sample to the first counts too. Its dual variable u in
  /// [-weight, weight] tilts the two ends of an open chain, and x[0] - x[N - 1] falls with u: a
  /// root find over u, started at `ring_dual`.
  /// @param ring_dual  start of the search; returns u, a good start for a nearby y
  void circular(const Eigen::VectorXd& y, double weight, double& ring_dual, Eigen::VectorXd& x);

 private:
  double ring_gap(const Eigen::VectorXd& y, double weight, double dual, Eigen::VectorXd& x);

  struct Knot {
    double position, slope_change, offset_change;
  };
  std::vector<Knot> knots_;
  std::vector<double> lower_, upper_;  // where x[n] is clipped, given x[n + 1]
  Eigen::VectorXd tilted_;
};

}  // namespace tofsmith
