// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/circulant_tv/optimality_scan.hpp"

#include <algorithm>

namespace tofsmith {
namespace {

// Finds the interval with the smallest slope; sums[0..length] are the prefix sums of the piece.
IntervalMove best_move(const PiecewiseConstant& x, int j, const double* sums, double weight,
                       int direction) {
  const Piece& piece = x[j];
  const double sign = direction;
  // Total variation changes by +weight at a new edge, and by the sign of an existing one.
  const double left_edge = sign * piece.rise * weight;
  const double right_edge = -sign * x[x.next(j)].rise * weight;
  IntervalMove best{j, 0, 0, direction, 0};
  double min_entry = left_edge - sign * sums[0];  // slope of the best left end up to k
  int entry = 0;
  double least = weight * 4;
  const int last = piece.length - 1;
  for (int k = 0; k < last; ++k) {
    const double slope = sign * sums[k + 1] + min_entry;
    if (slope < least) {
      least = slope;
      best.first = entry;
      best.last = k;
    }
    const double next_entry = weight - sign * sums[k + 1];
    if (next_entry < min_entry) {
      min_entry = next_entry;
      entry = k + 1;
    }
  }
  best.slope = least + weight;
  const double to_the_end = sign * sums[piece.length] + min_entry + right_edge;
  if (to_the_end < best.slope) {
    best.slope = to_the_end;
    best.first = entry;
    best.last = last;
  }
  return best;
}

// The complement of an interval across the origin does not cross it.
IntervalMove best_move_on_ring(const PiecewiseConstant& x, const double* sums, double weight,
                               int direction) {
  const int samples = x.samples();
  const double sign = direction;
  const double total = sign * sums[samples] - sign * sums[0];
  IntervalMove best{0, 0, samples - 1, direction, total};
  int highest = 0, lowest = 0;
  for (int k = 1; k <= samples; ++k) {
    const double sum = sign * sums[k];
    const double inside = sum - sign * sums[highest] + 2 * weight;
    if (inside < best.slope && k - highest < samples) best = {0, highest, k - 1, direction, inside};
    const double outside = total - (sum - sign * sums[lowest]) + 2 * weight;
    if (outside < best.slope && k - lowest < samples)
      best = {0, k % samples, lowest - 1 + (k < samples ? samples : 0), direction, outside};
    if (sum > sign * sums[highest]) highest = k;
    if (sum < sign * sums[lowest]) lowest = k;
  }
  return best;
}

bool can_move(const Piece& piece, int direction) {
  return direction > 0 ? piece.state != PieceState::at_upper : piece.state != PieceState::at_lower;
}

}  // namespace

void scan_for_moves(const PiecewiseConstant& x, const Eigen::VectorXd& sums, double weight,
                    OptimalityScan& scan) {
  scan.violation = 0;
  scan.moves.clear();
  int offset = 0;
  for (int j = 0; j < x.size(); ++j) {
    IntervalMove best;
    for (const int direction : {1, -1}) {
      if (!can_move(x[j], direction)) continue;
      const IntervalMove move = x.size() > 1
                                    ? best_move(x, j, sums.data() + offset, weight, direction)
                                    : best_move_on_ring(x, sums.data(), weight, direction);
      scan.violation = std::max(scan.violation, -move.slope / weight);
      const bool whole = move.last - move.first + 1 == x[j].length;
      if (whole && x[j].state == PieceState::free) continue;
      if (move.slope < best.slope) best = move;
    }
    if (best.slope < 0) scan.moves.push_back(best);
    offset += x[j].length;
  }
}

}  // namespace tofsmith
