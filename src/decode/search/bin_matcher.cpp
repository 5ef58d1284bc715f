// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/bin_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/shared/pixel_runs.hpp"
#include "core/shared/whole_vectors.hpp"

namespace tofsmith {

void ExactProjection::project(const double* raw, PlaneVector& vector) const {
  double size = 0.0;   // sum of |y'|
  double along = 0.0;  // ambient light
  std::fill_n(vector.unit.begin(), rank(), 0.0);
  for (int k = 0; k < measurements(); ++k) {
    const double y = electrons(raw[k], k);
    size += std::abs(y);
    along += ambient_[k] * y;
    for (int j = 0; j < rank(); ++j) vector.unit[static_cast<std::size_t>(j)] += basis_(k, j) * y;
  }
  double length2 = 0.0;
  for (int j = 0; j < rank(); ++j) {
    const double q = vector.unit[static_cast<std::size_t>(j)];
    length2 += q * q;
  }
  const double length = std::sqrt(length2);
  const bool is_seen = length > nothing_left * size;  // false for NaN
  vector.length = is_seen ? length : 0.0 * size;
  double residual2 = 0.0;
  for (int k = 0; k < measurements(); ++k) {
    const double left = electrons(raw[k], k) - along * ambient_[k];
    residual2 += left * left;
  }
  vector.residual = is_seen ? std::max(1.0, std::sqrt(residual2) / length) : 1.0;
  for (int j = 0; j < rank(); ++j) {
    double& unit = vector.unit[static_cast<std::size_t>(j)];
    unit = is_seen && std::isfinite(length) ? unit / length : 0.0;
  }
}

namespace {

/// Computes a unit vector and returns its squared length. Zero vectors remain zero.
template <typename Value>
Value normalized(const PixelTile& tile, int pixel, int rank,
                 std::array<Value, max_measurements>& unit) {
  Value length2 = 0;
  for (int j = 0; j < rank; ++j) {
    const Value q = tile.plane[j * pixels_per_tile + pixel];
    unit[static_cast<std::size_t>(j)] = q;
    length2 += q * q;
  }
  const Value scale = length2 > 0 ? 1 / std::sqrt(length2) : 0;
  for (int j = 0; j < rank; ++j) unit[static_cast<std::size_t>(j)] *= scale;
  return length2;
}

}  // namespace

BinMatcher::BinMatcher(const DecodingTable& table, const AmbientProjection& projection,
                       bool for_few)
    : directions_(projection),
      arcs_(directions_),
      distinct_(directions_),
      search_(make_search(for_few)),
      projection_(table, projection, min_distance()),
      exact_(table, projection) {}

BinMatcher::Search BinMatcher::make_search(bool for_few) const {
  if (CircleSearch::serves(distinct_)) return Search(std::in_place_type<CircleSearch>, distinct_);
  if (!for_few && CellTable::serves(distinct_))
    return Search(std::in_place_type<CellSearch>, distinct_);
  return {};
}

double BinMatcher::min_distance() const {
  if (const auto* circle = std::get_if<CircleSearch>(&search_)) return circle->min_gap();
  return std::holds_alternative<CellSearch>(search_) ? distinct_.shortest_step
                                                     : ArcSearch::min_distance;
}

void BinMatcher::match(const RawView& view, std::int64_t first, int pixels, bool for_outputs,
                       PixelTile& tile) const {
  projection_.project(view, first, pixels, for_outputs, tile);
  if (search(tile)) return;
  for (int i = 0; i < pixels; ++i)
    if (tile.bin[i] < 0) decide(view, first, i, tile);
}

void BinMatcher::match_plane(PixelTile& tile) const {
  std::fill_n(tile.error, whole_vectors(tile.pixels), 0.0f);
  if (search(tile)) return;
  for (int i = 0; i < tile.pixels; ++i) {
    if (tile.bin[i] >= 0) continue;
    std::array<double, max_measurements> unit;
    const double length2 = normalized(tile, i, exact_.rank(), unit);
    if (!std::isfinite(length2)) continue;
    tile.bin[i] = length2 > 0.0 ? choose(unit.data(), tie_tolerance) : distinct_.bin.front();
  }
}

/// @returns true if all bins are proven
bool BinMatcher::search(PixelTile& tile) const {
  if (const auto* circle = std::get_if<CircleSearch>(&search_)) return circle->search(tile);
  if (const auto* cells = std::get_if<CellSearch>(&search_)) return cells->search(tile);
  arcs_.search(tile.plane, pixels_per_tile, tile.error, tile.pixels, tile.bin);
  bool all_proven = true;
  for (int i = 0; i < tile.pixels; ++i) {
    const bool is_proven = tile.bin[i] >= 0 && is_precise(tile, i);
    tile.bin[i] = is_proven ? directions_.bin_of_row(tile.bin[i]) : -1;
    all_proven = all_proven && is_proven;
  }
  return all_proven;
}

/// Returns true if single precision determines the position of a pixel; if not, no search proves
/// its bin. Which other pixels need double precision depends on the processor, so their `plane`
/// must not be replaced.
bool BinMatcher::is_precise(const PixelTile& tile, int pixel) const {
  constexpr float share = 1e-5f;
  float largest = 0.0f;
  for (int j = 0; j < exact_.rank(); ++j)
    largest = std::max(largest, std::abs(tile.plane[j * pixels_per_tile + pixel]));
  return tile.error[pixel] < share * largest;
}

void BinMatcher::decide(const RawView& view, std::int64_t first, int pixel, PixelTile& tile) const {
  std::array<double, max_measurements> raw;
  for_each_run(view, first + pixel, 1, [&](const auto* number, std::int64_t, std::int64_t) {
    for (int k = 0; k < view.measurements; ++k)
      raw[static_cast<std::size_t>(k)] = static_cast<double>(number[k * view.measurement_stride]);
  });
  PlaneVector vector;
  exact_.project(raw.data(), vector);
  if (!is_precise(tile, pixel))
    for (int j = 0; j < exact_.rank(); ++j)
      tile.plane[j * pixels_per_tile + pixel] =
          static_cast<float>(vector.unit[static_cast<std::size_t>(j)] * vector.length);
  if (!std::isfinite(vector.length)) return;
  tile.bin[pixel] = vector.length > 0.0
                        ? choose(vector.unit.data(), tie_tolerance * vector.residual)
                        : distinct_.bin.front();
}

std::int32_t BinMatcher::choose(const double* unit, double tie) const {
  if (const auto* circle = std::get_if<CircleSearch>(&search_)) return circle->choose(unit, tie);
  // Directions that tie by more may not be in a run of the cell.
  if (const auto* cells = std::get_if<CellSearch>(&search_);
      cells && tie <= max_proven_residual * tie_tolerance)
    return cells->choose(unit, tie);
  return directions_.bin_of_row(arcs_.choose(directions_, unit, 1, tie));
}

}  // namespace tofsmith
