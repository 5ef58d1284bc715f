// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/direction_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/shared/whole_vectors.hpp"

namespace tofsmith {

namespace {

/// Returns the bin whose direction row n contains: the nearest earlier bin with contrast, or the
/// nearest later one for the first bins.
std::vector<std::int32_t> bins_of_rows(const RowMajorMatrix& curve) {
  const auto has_contrast = [&](Eigen::Index n) { return !curve.row(n).isZero(0.0); };
  std::int32_t current = 0;
  while (!has_contrast(current)) ++current;
  const auto samples = static_cast<std::int32_t>(curve.rows());
  const std::int32_t rows = rounded_up(samples, rows_per_block);
  std::vector<std::int32_t> bins(static_cast<std::size_t>(rows));
  for (std::int32_t n = 0; n < rows; ++n) {
    if (n < samples && has_contrast(n)) current = n;
    bins[static_cast<std::size_t>(n)] = current;
  }
  return bins;
}

}  // namespace

DirectionTable::DirectionTable(const AmbientProjection& projection)
    : samples_(static_cast<int>(projection.curve.rows())),
      rank_(projection.rank()),
      stride_(static_cast<std::size_t>(rank_) * rows_per_block),
      bin_of_row_(bins_of_rows(projection.curve)) {
  const RowMajorMatrix units = projection.curve.rowwise().normalized();
  directions_.resize(bin_of_row_.size() * static_cast<std::size_t>(rank_));
  for (std::size_t row = 0; row < bin_of_row_.size(); ++row)
    for (int j = 0; j < rank_; ++j)
      directions_[row / rows_per_block * stride_ + static_cast<std::size_t>(j) * rows_per_block +
                  row % rows_per_block] = units(bin_of_row_[row], j);
}

std::vector<std::int32_t> lowest_alike(const RowMajorMatrix& unit, double tolerance) {
  const auto rows = static_cast<std::int32_t>(unit.rows());
  std::vector<std::int32_t> lowest(static_cast<std::size_t>(rows)), order;
  std::iota(lowest.begin(), lowest.end(), 0);
  for (std::int32_t n = 0; n < rows; ++n)
    if (!unit.row(n).isZero(0.0)) order.push_back(n);

  // Equal directions are adjacent after sorting.
  Eigen::VectorXd weights(unit.cols());
  for (Eigen::Index j = 0; j < weights.size(); ++j) weights[j] = std::cos(1.0 + double(j));
  const Eigen::VectorXd key = unit * weights.normalized();
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return key[a] < key[b]; });
  for (auto a = order.begin(); a != order.end(); ++a) {
    for (auto b = a + 1; b != order.end() && key[*b] - key[*a] <= tolerance; ++b) {
      if ((unit.row(*a) - unit.row(*b)).norm() > tolerance) continue;
      auto& of_higher = lowest[static_cast<std::size_t>(std::max(*a, *b))];
      of_higher = std::min({of_higher, *a, *b});
    }
  }
  return lowest;
}

DistinctDirections::DistinctDirections(const DirectionTable& table) {
  const std::int32_t samples = table.samples();
  RowMajorMatrix all = RowMajorMatrix::Zero(samples, table.rank());
  for (std::int32_t n = 0; n < samples; ++n)
    if (table.bin_of_row(n) == n)
      for (int j = 0; j < table.rank(); ++j) all(n, j) = table.direction(n, j);

  const std::vector<std::int32_t> lowest = lowest_alike(all, 0.5 * tie_tolerance);
  for (std::int32_t n = 0; n < samples; ++n)
    if (!all.row(n).isZero(0.0) && lowest[static_cast<std::size_t>(n)] == n) bin.push_back(n);
  unit = all(bin, Eigen::all);

  shortest_step = std::numeric_limits<double>::infinity();
  for (std::int32_t n = 0; n < count(); ++n)
    shortest_step = std::min(shortest_step, (unit.row(next(n)) - unit.row(n)).norm());
}

}  // namespace tofsmith
