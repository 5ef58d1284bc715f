// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

namespace tofsmith {

/// Projects `x` in place onto { 0 <= x <= upper_bound, sum x <= budget }:
///   x <- clip(x - price, 0, upper_bound) with the smallest price >= 0 that meets the budget.
/// @return the price; 0 if the budget is inactive
double project_on_box_and_budget(Eigen::VectorXd& x, double upper_bound,
                                 const std::optional<double>& budget);

}  // namespace tofsmith
