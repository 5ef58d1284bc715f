// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/search/cell_table.hpp"
#include "decode/search/shared/pixel_tile.hpp"

namespace tofsmith {

struct CellSearchView {
  int rank = 0;
  int root_bits = 0;
  int cut_bits = 0;
  const std::int32_t* roots = nullptr;  ///< rank 4 only
  const CellRecord* cells = nullptr;
  const CellRecord* lists = nullptr;
  float fit_unit = 0.0f;
  std::int32_t count = 0;        ///< M directions
  const float* steps = nullptr;  ///< unit vector from n to n + 1 at [n + 1], n = -1 ... 2 M; 4 each
  const float* units = nullptr;  ///< n = 0 ... 2 M, 4 each
  const std::int32_t* bin = nullptr;  ///< of a direction; null if all bins are distinct
  float steepest_fit = 0.0f;
  float rounding = 0.0f;  ///< error of the sign of <q, step>, per sum of |q_j|
};

/// Finds the closest directions with cells, which contain runs of neighbouring directions. The sign
/// of <q, u_(n+1) - u_n> decides on which side of n the best direction lies. Differences are
/// rounded from double precision, so a sign is correct unless the product is close to 0.
class CellSearch {
 public:
  /// @param directions  with CellTable::serves(directions)
  explicit CellSearch(const DistinctDirections& directions);

  const CellTable& table() const { return table_; }
  const CellSearchView& view() const { return view_; }
  std::span<const float> steps() const { return steps_; }
  std::span<const float> units() const { return units_; }
  /// Bin of every direction (M), ascending.
  std::span<const std::int32_t> bins() const { return bin_; }

  /// Fills the bins of a tile; -1 if single precision does not prove that a bin leads by more than
  /// the margin of ties (see TileProjection).
  /// @returns true if all are proven
  bool search(PixelTile& tile) const;
  /// Returns the lowest bin whose score ties with the best, in double precision.
  /// @param unit  (rank), of length 1
  /// @param tie   margin of ties, up to max_proven_residual tie_tolerance
  std::int32_t choose(const double* unit, double tie) const;

 private:
  CellTable table_;
  std::vector<std::int32_t> bin_;
  RowMajorMatrix unit_;  // (M, rank)
  std::vector<float> steps_;
  std::vector<float> units_;
  CellSearchView view_;
};

}  // namespace tofsmith
