// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/bin_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {
constexpr int width = pixels_per_tile;
/// Below this share of what is measured, what is left of it is rounding.
constexpr double nothing = 1e-12;
}  // namespace

BinMatcher::BinMatcher(const DecodingTable& table, const AmbientProjection& projection)
    : directions_(projection), basis_(projection.basis), gain_e_per_raw_(table.gain_e_per_raw) {
  for (const double dark_e : table.dark_electrons)
    dark_raw_.push_back(table.black_level + dark_e / table.gain_e_per_raw);
}

/// The float search proposes a block and double arithmetic chooses in it. Where the proposal is not
/// proven, double arithmetic chooses among all.
void BinMatcher::match(const float* raw, int pixels, Tile& tile) const {
  tile.pixels = pixels;
  project(raw, tile);
  BestBlocks best;
  search_blocks(directions_, tile.unit_float, best);
  const float proven = directions_.proof_margin();
  for (int i = 0; i < pixels; ++i) {
    if (!std::isfinite(tile.length[i]))
      tile.bin[i] = -1;
    else if (best.lead[i] > proven)
      tile.bin[i] = choose(tile, i, best.block[i], best.block[i]);
    else
      tile.bin[i] = choose(tile, i, 0, directions_.blocks() - 1);
  }
}

/// q = V^T y' of all pixels; V spans what is left after P, so that P itself need not be applied.
void BinMatcher::project(const float* raw, Tile& tile) const {
  const auto count = static_cast<int>(basis_.rows());
  double size[width] = {}, y[width] = {};
  std::fill_n(tile.unit, directions_.rank() * width, 0.0);
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < tile.pixels; ++i) y[i] = electrons(raw[i * count + k], k);
    for (int i = 0; i < width; ++i) size[i] += std::abs(y[i]);
    for (int j = 0; j < directions_.rank(); ++j) {
      const double weight = basis_(k, j);
      for (int i = 0; i < width; ++i) tile.unit[j * width + i] += weight * y[i];
    }
  }
  normalize(size, tile);
}

/// @param size  sum of |y'| of every pixel: finite unless a measurement is not
void BinMatcher::normalize(const double* size, Tile& tile) const {
  double scale[width] = {};
  for (int j = 0; j < directions_.rank(); ++j)
    for (int i = 0; i < width; ++i) scale[i] += tile.unit[j * width + i] * tile.unit[j * width + i];
  for (int i = 0; i < width; ++i) {
    const double length = std::sqrt(scale[i]);
    const bool is_seen = length > nothing * size[i];  // false for NaN
    tile.length[i] = is_seen ? length : 0.0 * size[i];
    scale[i] = is_seen ? 1.0 / length : 0.0;
  }
  for (int j = 0; j < directions_.rank(); ++j)
    for (int i = 0; i < width; ++i) {
      double& unit = tile.unit[j * width + i];
      unit = scale[i] > 0.0 ? unit * scale[i] : 0.0;
      tile.unit_float[j * width + i] = static_cast<float>(unit);
    }
}

/// The lowest row of the blocks whose score ties with the best of them.
std::int32_t BinMatcher::choose(const Tile& tile, int pixel, int first_block,
                                int last_block) const {
  double scores[rows_per_block];
  const auto score_block = [&](int b) {
    const double* directions = directions_.block(b);
    std::fill_n(scores, rows_per_block, 0.0);
    for (int j = 0; j < directions_.rank(); ++j)
      for (int row = 0; row < rows_per_block; ++row)
        scores[row] += tile.unit[j * width + pixel] * directions[j * rows_per_block + row];
  };
  double best = -2.0;
  for (int b = first_block; b <= last_block; ++b) {
    score_block(b);
    best = std::max(best, *std::max_element(scores, scores + rows_per_block));
  }
  for (int b = first_block; b <= last_block; ++b) {
    if (first_block != last_block) score_block(b);
    for (int row = 0; row < rows_per_block; ++row)
      if (scores[row] >= best - tie_tolerance)
        return directions_.bin_of_row(b * rows_per_block + row);
  }
  return -1;
}

}  // namespace tofsmith
