// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/search/direction_table.hpp"

namespace tofsmith {

/// Returns, for every row, the lowest row whose direction is within `tolerance`, or the row itself.
/// Zero rows have no direction and return themselves.
std::vector<std::int32_t> lowest_alike(const RowMajorMatrix& unit, double tolerance);

/// Directions of the curve of a code that can be best: among directions that always tie, only that
/// of the lowest bin.
struct DistinctDirections {
  explicit DistinctDirections(const DirectionTable& table);

  std::int32_t count() const { return static_cast<std::int32_t>(bin.size()); }
  int rank() const { return static_cast<int>(unit.cols()); }
  std::int32_t next(std::int32_t n) const { return n + 1 < count() ? n + 1 : 0; }

  RowMajorMatrix unit;            ///< (M, rank), by ascending bin
  std::vector<std::int32_t> bin;  ///< (M)
  double shortest_step = 0.0;     ///< least distance between neighbours, including last and first
};

}  // namespace tofsmith
