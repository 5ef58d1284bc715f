// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {

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
