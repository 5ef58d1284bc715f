// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "design/circulant_tv/piecewise_constant.hpp"

namespace tofsmith {

/// Raises (+1) or lowers (-1) the samples [first, last] of one piece, counted from its start.
struct IntervalMove {
  int piece = 0, first = 0, last = 0, direction = 0;
  double slope = 0;  ///< of the objective, per unit of height; negative if the move lowers it
};

struct OptimalityScan {
  double violation = 0;  ///< -(smallest slope) / weight over all intervals; 0 if none is negative
  std::vector<IntervalMove> moves;  ///< best move of each piece that lowers the objective and
                                    ///< splits the piece
};

/// Searches all intervals of all pieces for moves that lower the objective. For a signal with given
/// jumps these are all descent directions, so their absence proves optimality. One pass over the
/// prefix sums (Kadane's maximum subarray, once per direction).
/// @param sums    prefix sums of the gradient of the smooth term from the start of piece 0 (N + 1)
/// @param weight  total-variation weight
void scan_for_moves(const PiecewiseConstant& x, const Eigen::VectorXd& sums, double weight,
                    OptimalityScan& scan);

}  // namespace tofsmith
