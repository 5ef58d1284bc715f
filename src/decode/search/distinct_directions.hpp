// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "decode/search/direction_table.hpp"

namespace tofsmith {

/// For every row the lowest row whose direction is no further away than `tolerance`; its own number
/// where there is none. Rows of zeros have no direction and stand for themselves.
std::vector<std::int32_t> lowest_alike(const RowMajorMatrix& unit, double tolerance);

/// The directions of a code's curve that can win: of those that always tie only the lowest bin's.
struct DistinctDirections {
  explicit DistinctDirections(const DirectionTable& table);

  std::int32_t count() const { return static_cast<std::int32_t>(bin.size()); }
  int rank() const { return static_cast<int>(unit.cols()); }
  std::int32_t next(std::int32_t n) const { return n + 1 < count() ? n + 1 : 0; }

  RowMajorMatrix unit;            ///< (M, rank), by increasing bin
  std::vector<std::int32_t> bin;  ///< (M)
  double shortest_step = 0.0;     ///< least distance between neighbours, the ends being neighbours
};

}  // namespace tofsmith
