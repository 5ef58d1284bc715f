// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/bin_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

BinMatcher::BinMatcher(const DecodingTable& table, const AmbientProjection& projection)
    : directions_(projection),
      distinct_(directions_),
      projection_(table, projection),
      exact_(table, projection) {
  if (CircleSearch::serves(distinct_))
    search_.emplace<CircleSearch>(distinct_, directions_);
  else if (CellTable::serves(distinct_))
    search_.emplace<CellSearch>(distinct_, directions_);
}

void BinMatcher::match(const RawView& view, std::int64_t first, int pixels, bool keep_raw,
                       PixelTile& tile) const {
  projection_.project(view, first, pixels, keep_raw, tile);
  if (search(tile)) return;
  for (int i = 0; i < pixels; ++i)
    if (tile.bin[i] < 0) tile.bin[i] = decide(view, first + i);
}

/// @returns whether all bins are proven
bool BinMatcher::search(PixelTile& tile) const {
  if (const auto* circle = std::get_if<CircleSearch>(&search_)) return circle->search(tile);
  if (const auto* cells = std::get_if<CellSearch>(&search_)) return cells->search(tile);
  std::fill_n(tile.bin, tile.pixels, -1);
  return false;
}

/// Rivals that the search does not know with the bin.
void BinMatcher::find_rivals(PixelTile& tile) const {
  const auto* circle = std::get_if<CircleSearch>(&search_);
  if (!circle) return;
  for (int i = 0; i < tile.pixels; ++i)
    tile.rival[i] = tile.bin[i] < 0 ? -1 : circle->rival(tile.bin[i]);
}

/// One pixel in double arithmetic.
std::int32_t BinMatcher::decide(const RawView& view, std::int64_t pixel) const {
  std::array<double, max_measurements> raw;
  const std::int64_t row = pixel / view.width, column = pixel % view.width;
  std::visit(
      [&](const auto* data) {
        const auto* numbers = data + row * view.row_stride + column * view.column_stride;
        for (int k = 0; k < view.measurements; ++k)
          raw[static_cast<std::size_t>(k)] =
              static_cast<double>(numbers[k * view.measurement_stride]);
      },
      view.data);
  PlaneVector vector;
  exact_.project(raw.data(), vector);
  if (!std::isfinite(vector.length)) return -1;
  return vector.length > 0.0 ? choose(vector.unit.data()) : distinct_.bin.front();
}

/// The lowest bin whose score ties with the best.
std::int32_t BinMatcher::choose(const double* unit) const {
  if (const auto* circle = std::get_if<CircleSearch>(&search_)) return circle->choose(unit);
  if (const auto* cells = std::get_if<CellSearch>(&search_)) return cells->choose(unit);
  const Eigen::VectorXd score =
      distinct_.unit * Eigen::Map<const Eigen::VectorXd>(unit, distinct_.rank());
  const double least = score.maxCoeff() - tie_tolerance;
  std::int32_t n = 0;
  while (score[n] < least) ++n;
  return distinct_.bin[static_cast<std::size_t>(n)];
}

}  // namespace tofsmith
