// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "decode/search/arc_table.hpp"

namespace tofsmith {

/// Finds the direction closest to a vector without looking at most of them: whole arcs of the curve
/// are passed over where a bound proves that the best one is not there. For any rank.
class ArcSearch {
 public:
  /// Rows are told apart as if they were as far from each other as this at least.
  static constexpr double min_distance = 2 * ArcTable::min_window_radius;

  explicit ArcSearch(const DirectionTable& directions, std::int32_t blocks_per_arc = 1)
      : table_(directions, blocks_per_arc) {}

  const ArcTable& table() const { return table_; }

  /// Rows with the highest scores, for vectors q of any length.
  /// @param plane   [rank][stride]: q of pixel i is plane[i], plane[stride + i], ..
  /// @param error   (pixels): bounds |q - q_exact|; infinite where nothing can be proven. With a
  ///                little more, which is what ties need (see TileProjection), the row leads by
  ///                that
  /// @param row     (pixels): the row whose score with q_exact leads, in exact arithmetic, by more
  ///                than tie_tolerance |q| over every other direction (the lowest row with that
  ///                direction), or -1 where single precision cannot prove it
  void search(const float* plane, int stride, const float* error, int pixels,
              std::int32_t* row) const;

  /// Finds local maxima along the rows whose score is within `slack` of the best; if there are more
  /// than `room`, the best ones.
  /// @param unit   a unit vector (rank)
  /// @param found  receives the rows
  /// @return how many were found
  int near_peaks(const float* unit, float slack, int room, std::int32_t* found) const;

  /// The lowest row whose score is within `tie` of the best, for scores that are sums of
  /// products in double, rounded one by one from the first component to the last.
  /// @param directions  of which this search was made
  /// @param unit        a unit vector (or zero: row 0) with components unit[j * stride]
  std::int32_t choose(const DirectionTable& directions, const double* unit, int stride,
                      double tie) const;

 private:
  ArcTable table_;
};

}  // namespace tofsmith
