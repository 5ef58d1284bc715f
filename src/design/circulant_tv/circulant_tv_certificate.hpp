// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {

/// How far a signal is from satisfying the optimality conditions of a CirculantTvProblem.
struct OptimalityCertificate {
  /// Least violation of the dual conditions found, in units of the total-variation weight.
  double violation = 0;
  /// Largest excess over a bound (in units of the upper bound) or the budget (relative).
  double infeasibility = 0;
  double budget_multiplier = 0;  ///< the price of the budget that gives this violation

  double worst() const { return violation > infeasibility ? violation : infeasibility; }
};

/// Judges any x by constructing the dual path, independently of how x was found.
///
/// x is optimal if and only if there is a price nu >= 0 of the budget (0 where the budget has room)
/// and a path u[n] on the jumps between samples n and n + 1 with |u| <= w, u = w sign(jump) at
/// every jump, and u[n] - u[n - 1] = g[n] + nu at samples inside the bounds, <= at samples on the
/// lower and >= at samples on the upper bound; g is the gradient of the least-squares term. The
/// interval of all admissible u[n] is carried around the ring from a jump; where it becomes empty
/// it is moved back, and the moves between two jumps add up to that piece's violation.
/// The violation is convex in nu; a golden-section search finds the best. O(N log N).
/// @param x  (N), finite; jumps below 1e-12 of the upper bound count as none
/// @throws std::invalid_argument if the problem is not valid or x has another length
OptimalityCertificate certificate(const CirculantTvProblem& problem, const Eigen::VectorXd& x);

}  // namespace tofsmith
