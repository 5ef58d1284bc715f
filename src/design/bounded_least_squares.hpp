// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/design/circulant_tv.hpp"

namespace tofsmith {

/// The sub-problem without total variation, whose weight is not read:
///   minimize 1/2 |A x - b|^2  subject to  0 <= x <= upper_bound,  sum x <= budget
/// by accelerated projected gradients. It has many solutions wherever A damps much: x keeps of
/// `start` (N) what the data do not determine. For comparison with designs that have a weight.
/// @return feasible (N); the objective is not above that of the projected start
Eigen::VectorXd least_squares_within_bounds(const CirculantTvProblem& problem,
                                            const Eigen::VectorXd& start);

}  // namespace tofsmith
