// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/search/direction_table.hpp"

namespace tofsmith {

/// Returns the lowest row within `tolerance` of each row; zero rows return themselves.
std::vector<std::int32_t> lowest_alike(const RowMajorMatrix& unit, double tolerance);

/// Directions that can be best: of directions that always tie, only the lowest bin's.
struct DistinctDirections {
  explicit DistinctDirections(const DirectionTable& table);

  std::int32_t count() const { return static_cast<std::int32_t>(bin.size()); }
  int rank() const { return static_cast<int>(unit.cols()); }
  std::int32_t next(std::int32_t n) const { return n + 1 < count() ? n + 1 : 0; }

  RowMajorMatrix unit;            ///< (M, rank), by ascending bin
  std::vector<std::int32_t> bin;  ///< (M)
  double shortest_step = 0.0;     ///< between neighbours (cyclic)
};

}  // namespace tofsmith
