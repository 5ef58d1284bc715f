// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/circulant_tv/piecewise_constant.hpp"

namespace tofsmith {

/// Raising (+1) or dropping (-1) the samples [first, last] of one piece, counted from its start.
struct IntervalMove {
  int piece = 0, first = 0, last = 0, direction = 0;
  double slope = 0;  ///< of the objective, per unit of height; negative when the move pays
};

struct OptimalityScan {
  double violation = 0;  ///< -(least slope) / weight over all intervals; 0 when none pays
  std::vector<IntervalMove> moves;  ///< best paying one of each piece that changes the structure
};

/// Searches every interval of every piece for one whose raise or drop lowers the objective: for a
/// signal of given jumps these are all its ways down, and their absence proves optimality. One
/// pass over the prefix sums (Kadane's largest sub-array sum, once per direction).
/// @param sums    prefix sums of the gradient of the smooth part from the start of piece 0 (N + 1)
/// @param weight  of total variation
void scan_for_moves(const PiecewiseConstant& x, const Eigen::VectorXd& sums, double weight,
                    OptimalityScan& scan);

}  // namespace tofsmith
