// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/bin_matcher.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tofsmith {

namespace {
constexpr int width = pixels_per_tile;

/// Index of the first score that is at least `least`, or their number. Free of branches, which
/// nobody could predict.
template <typename Scores>
int first_at_least(const Scores& scores, double least) {
  unsigned reached = 1u << rows_per_block;
  for (int row = 0; row < rows_per_block; ++row)
    reached |= static_cast<unsigned>(scores[row] >= least) << row;
  return std::countr_zero(reached);
}

}  // namespace

BinMatcher::BinMatcher(const DecodingTable& table, const AmbientProjection& projection)
    : directions_(projection), basis_(projection.basis), scale_(table) {}

/// The float search proposes a block and double arithmetic chooses in it. Where the proposal is not
/// proven, double arithmetic chooses among all.
void BinMatcher::match(const float* raw, int pixels, Tile& tile) const {
  tile.pixels = pixels;
  project(raw, tile);
  BestBlocks best;
  search_blocks(directions_, tile.unit_float, best);
  const float proven = directions_.proof_margin();
  for (int i = 0; i < pixels; ++i) {
    const int row = best.lead[i] > proven ? choose_in(tile, i, best.block[i]) : choose(tile, i);
    tile.bin[i] = std::isfinite(tile.length[i]) ? directions_.bin_of_row(row) : -1;
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
    const bool is_seen = length > nothing_left * size[i];  // false for NaN
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

BinMatcher::BlockScores BinMatcher::scores(const Tile& tile, int pixel, int block) const {
  const double* directions = directions_.block(block);
  BlockScores sum = tile.unit[pixel] * Eigen::Map<const BlockScores>(directions);
  for (int j = 1; j < directions_.rank(); ++j)
    sum += tile.unit[j * width + pixel] *
           Eigen::Map<const BlockScores>(directions + j * rows_per_block);
  return sum;
}

/// The lowest row of a block whose score ties with the best in it.
int BinMatcher::choose_in(const Tile& tile, int pixel, int block) const {
  const BlockScores all = scores(tile, pixel, block);
  return block * rows_per_block + first_at_least(all, all.maxCoeff() - tie_tolerance);
}

/// The lowest of all rows whose score ties with the best.
int BinMatcher::choose(const Tile& tile, int pixel) const {
  double best = -2.0;
  for (int b = 0; b < directions_.blocks(); ++b)
    best = std::max(best, scores(tile, pixel, b).maxCoeff());
  int block = 0, row = rows_per_block;
  while (row == rows_per_block)
    row = first_at_least(scores(tile, pixel, block++), best - tie_tolerance);
  return (block - 1) * rows_per_block + row;
}

}  // namespace tofsmith
