// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/distinct_directions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tofsmith {

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
