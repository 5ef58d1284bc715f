// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {

struct OptimalityCertificate {
  /// Violation of the dual conditions, in units of the total-variation weight.
  double violation = 0;
  /// Relative violation of a bound or of the budget.
  double infeasibility = 0;
  double budget_multiplier = 0;  ///< price of the budget

  double worst() const { return violation > infeasibility ? violation : infeasibility; }
};

/// Computes the certificate of any x by constructing the dual path.
///
/// x is optimal if and only if there are a price nu >= 0 of the budget (0 if inactive) and a path
/// u[n] between samples n and n + 1 with |u| <= w, u = w sign(jump) at every jump, and u[n] - u[n -
/// 1] = g[n] + nu inside the bounds, <= at the lower and >= at the upper bound; g is the gradient
/// of the least-squares term. The interval of admissible u[n] is propagated around the ring from a
/// jump. An empty interval is shifted back; the shifts between two jumps add up to the violation of
/// the piece, which is convex in nu and minimized by golden-section search. O(N log N).
/// @param x  (N), finite; jumps below 1e-12 of the upper bound are ignored
/// @throws std::invalid_argument if the problem is invalid or the length of x differs
OptimalityCertificate certificate(const CirculantTvProblem& problem, const Eigen::VectorXd& x);

struct CirculantTvAdmmOptions {
  int max_iterations = 20000;
  double tolerance = 1e-11;  ///< RMS of both residuals / upper bound, > 0
  double certificate_tolerance = 1e-7;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// ADMM with one split: x minimizes the data term (a division of spectra); z satisfies the rest by
/// the exact proximal map
///   prox(v) = clip(prox_TV(v) - mu, 0, upper_bound),  mu >= 0 the price of the budget.
/// Slow, and independent of the active set.
/// @param warm_start  initial x (N, finite), or empty
/// @return z, feasible, with its certificate; stalled if the residuals vanish but the certificate
///   exceeds its tolerance
/// @throws std::invalid_argument if problem, options or start are invalid
CirculantTvResult solve_circulant_tv_by_admm(const CirculantTvProblem& problem,
                                             const CirculantTvAdmmOptions& options = {},
                                             const std::optional<Eigen::VectorXd>& warm_start = {});

}  // namespace tofsmith
