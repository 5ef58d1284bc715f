// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace tofsmith {

/// Returns the items of exposures in another order.
/// @param items  the same number for each exposure; other lists are returned unchanged
/// @param order  present number of each new exposure
template <typename Item>
std::vector<Item> in_exposure_order(const std::vector<Item>& items, const std::vector<int>& order) {
  if (items.size() % order.size() != 0) return items;
  const auto side = static_cast<std::ptrdiff_t>(items.size() / order.size());
  std::vector<Item> ordered;
  for (const int e : order)
    ordered.insert(ordered.end(), items.begin() + e * side, items.begin() + (e + 1) * side);
  return ordered;
}

}  // namespace tofsmith
