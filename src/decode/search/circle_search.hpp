// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode/search/distinct_directions.hpp"
#include "decode/search/shared/pixel_tile.hpp"

namespace tofsmith {

/// A piece of a side of the square around the circle: below `border` one bin is the closest, above
/// it another.
struct CirclePiece {
  static constexpr float overlap = 2e-5f;  ///< how far pieces reach beyond their ends, in c

  float border = 0.0f;      ///< in c of the side; NaN where more than two bins can be the closest
  std::uint16_t below = 0;  ///< bin
  std::uint16_t above = 0;  ///< bin
};
static_assert(sizeof(CirclePiece) == 8);

/// Closest directions in the plane, rank 2: bins by angle. Side 2 j + (q_j < 0) of the square holds
/// the vectors whose larger component is j; c = q_other / |q_j| in [-1, 1] is cut into pieces.
class CircleSearch {
 public:
  static bool serves(const DistinctDirections& directions);
  /// @param directions  with serves(directions)
  explicit CircleSearch(const DistinctDirections& directions);

  /// As CellSearch::search.
  bool search(PixelTile& tile) const;
  /// Of the four sides, one after another; as many of each.
  std::span<const CirclePiece> pieces() const { return pieces_; }
  int resolution() const { return resolution_; }
  /// By how much c must be off a border.
  float margin() const { return margin_; }
  /// As CellSearch::choose, for any `tie`.
  std::int32_t choose(const double* unit, double tie) const;
  /// Between neighbours on the circle [rad].
  double min_gap() const { return min_gap_; }

 private:
  void cut_into_pieces();
  CirclePiece piece(int side, double begin, double end) const;
  std::size_t owner(double angle) const;
  double score(const double* unit, std::size_t i) const;

  int resolution_ = 0;  // pieces of a side
  std::vector<CirclePiece> pieces_;
  std::vector<double> angle_;      // of the distinct directions, ascending
  std::vector<double> border_;     // angle half-way to the next one
  std::vector<std::int32_t> bin_;  // of the same
  RowMajorMatrix unit_;            // (M, 2) of the same
  double min_gap_ = 0.0;
  float margin_ = 0.0f;  // of a comparison of c
};

}  // namespace tofsmith
