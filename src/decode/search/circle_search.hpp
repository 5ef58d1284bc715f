// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "decode/search/direction_table.hpp"
#include "decode/search/shared/pixel_tile.hpp"

namespace tofsmith {

/// Piece of a side of the square around the circle, with the closest bins below and above `border`.
struct CirclePiece {
  static constexpr float overlap = 2e-5f;  ///< in c

  float border = 0.0f;  ///< in c of the side; NaN if more than two bins can be closest
  std::uint16_t below = 0;
  std::uint16_t above = 0;
};
static_assert(sizeof(CirclePiece) == 8);

/// Finds the closest directions for rank 2, by angle. Side 2 j + (q_j < 0) of the square contains
/// the vectors whose larger component is j; c = q_other / |q_j| in [-1, 1] is divided into pieces.
class CircleSearch {
 public:
  static bool serves(const DistinctDirections& directions);
  explicit CircleSearch(const DistinctDirections& directions);

  bool search(PixelTile& tile) const;
  /// Pieces of the four sides in order.
  std::span<const CirclePiece> pieces() const { return pieces_; }
  int resolution() const { return resolution_; }
  /// Required distance of c from a border.
  float margin() const { return margin_; }
  /// As CellSearch::choose(), for any `tie`.
  std::int32_t choose(const double* unit, double tie) const;
  /// Least angle between neighbouring directions [rad].
  double min_gap() const { return min_gap_; }

 private:
  void cut_into_pieces();
  CirclePiece piece(int side, double begin, double end) const;
  std::size_t owner(double angle) const;
  double score(const double* unit, std::size_t i) const;

  int resolution_ = 0;
  std::vector<CirclePiece> pieces_;
  std::vector<double> angle_;      // of the distinct directions, ascending
  std::vector<double> border_;     // angle half-way to the next direction
  std::vector<std::int32_t> bin_;  // of the directions
  RowMajorMatrix unit_;            // (M, 2)
  double min_gap_ = 0.0;
  float margin_ = 0.0f;
};

}  // namespace tofsmith
