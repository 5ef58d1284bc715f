// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/search/cell_table.hpp"
#include "decode/search/shared/pixel_tile.hpp"

namespace tofsmith {

/// What the search reads, as plain memory.
struct CellSearchView {
  int rank = 0;
  int root_bits = 0;
  int cut_bits = 0;
  const std::int32_t* roots = nullptr;  ///< of rank 4; rank 3 has no cuts
  const CellRecord* cells = nullptr;
  const CellRecord* lists = nullptr;
  float fit_unit = 0.0f;
  std::int32_t count = 0;        ///< M directions
  const float* steps = nullptr;  ///< unit vector from n to n + 1 at [n + 1], n = -1 .. 2 M, each 4
  const float* units = nullptr;  ///< directions n = 0 .. 2 M, each 4
  const std::int32_t* bin = nullptr;  ///< of a direction; null where all bins are distinct
  float steepest_fit = 0.0f;          ///< as of the table
  float rounding = 0.0f;              ///< of the sign of <q, step>, per sum of |q_j|
};

/// Closest directions by cells: a cell names one run of neighbouring directions, or a few, and the
/// sign of <q, u_(n+1) - u_n> tells on which side of n the winner stands. Differences are rounded
/// from double arithmetic, so that a sign is right unless it is close to 0.
class CellSearch {
 public:
  /// @param directions  with CellTable::serves(directions)
  explicit CellSearch(const DistinctDirections& directions);

  const CellTable& table() const { return table_; }
  const CellSearchView& view() const { return view_; }
  /// As in the view.
  std::span<const float> steps() const { return steps_; }
  std::span<const float> units() const { return units_; }
  /// Bin of every direction (M), by increasing bin.
  std::span<const std::int32_t> bins() const { return bin_; }

  /// Fills bin of a tile from plane and error: -1 where single precision does not prove that it
  /// beats all others by more than ties need (see TileProjection).
  /// @returns whether all are proven
  bool search(PixelTile& tile) const;
  /// The lowest bin whose score ties with the best, in double arithmetic.
  /// @param unit  (rank) of length 1
  /// @param tie   by how much scores may differ: up to max_proven_residual tie_tolerance
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
