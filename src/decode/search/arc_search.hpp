// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "decode/search/arc_table.hpp"

namespace tofsmith {

/// Finds the direction closest to a vector by branch and bound over arcs of the curve, for any
/// rank.
class ArcSearch {
 public:
  static constexpr double min_distance = 2 * ArcTable::min_window_radius;

  explicit ArcSearch(const DirectionTable& directions) : table_(directions) {}

  const ArcTable& table() const { return table_; }

  /// Finds the rows with the highest scores.
  /// @param plane   [rank][stride]: q of pixel i is plane[i], plane[stride + i], ...
  /// @param error   (pixels): bound on |q - q_exact| including the margin for ties (see
  ///     TileProjection); infinite if nothing can be proven
  /// @param row     (pixels): row whose exact score exceeds that of every other direction by more
  ///     than tie_tolerance |q| (the lowest row with that direction), or -1 if single precision
  ///     cannot prove it
  void search(const float* plane, int stride, const float* error, int pixels,
              std::int32_t* row) const;

  /// Finds local maxima whose score is within `slack` of the best; at most `room`, the best ones.
  /// @param unit   a unit vector (rank)
  /// @return number of rows found
  int near_peaks(const float* unit, float slack, int room, std::int32_t* found) const;

  /// Returns the lowest row whose score is within `tie` of the best. Scores are sums of products in
  /// double precision, rounded one by one from the first component to the last.
  /// @param directions  as in the constructor
  std::int32_t choose(const DirectionTable& directions, const double* unit, int stride,
                      double tie) const;

 private:
  ArcTable table_;
};

}  // namespace tofsmith
