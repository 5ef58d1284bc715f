// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/circulant_tv/piecewise_constant.hpp"

namespace tofsmith {

/// Raises (+1) or lowers (-1) the samples [first, last], counted from the start of a piece.
struct IntervalMove {
  int piece = 0, first = 0, last = 0, direction = 0;
  double slope = 0;  ///< of the objective per unit of height
};

struct OptimalityScan {
  double violation = 0;             ///< -(smallest slope) / weight, or 0
  std::vector<IntervalMove> moves;  ///< best descent of each piece that splits it
};

/// Searches all intervals of all pieces for descent directions, in one pass over the prefix sums
/// per direction (Kadane). For given jumps, finding none proves optimality.
/// @param sums  prefix sums of the gradient of the smooth term from piece 0 (N + 1)
/// @param weight  total-variation weight
void scan_for_moves(const PiecewiseConstant& x, const Eigen::VectorXd& sums, double weight,
                    OptimalityScan& scan);

}  // namespace tofsmith
