// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "decode/direction_table.hpp"

namespace tofsmith {

/// Pixels that are searched together; a multiple of twice the vector length used.
inline constexpr int pixels_per_tile = 64;

/// The best block of each pixel of a tile, by single precision scores.
struct BestBlocks {
  std::int32_t block[pixels_per_tile];  ///< the lowest of those with the best score
  float lead[pixels_per_tile];          ///< of its best score over those of all other blocks
};

/// Searches all blocks for the directions closest to unit vectors in float, `components`
/// [rank][pixels_per_tile].
void search_blocks(const DirectionTable& table, const float* components, BestBlocks& best);

/// Bin with the best score in [begin, end), begin >= 0, end <= 2 N, modulo N: the lowest position
/// of those that tie. `components` (rank) is one vector. The same on every processor: products and
/// sums are rounded one by one.
std::int32_t best_bin_within(const DirectionTable& table, const float* components,
                             std::int32_t begin, std::int32_t end);

}  // namespace tofsmith
