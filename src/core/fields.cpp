// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/fields.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace tofsmith {

std::string error_name(std::string_view name) {
  for (const std::string_view end : {"_m", "_mde"})
    if (name.ends_with(end)) name.remove_suffix(end.size());
  return std::string(name) + "_se_m";
}

int scaled_count(int count, double effort, ByEffort by_effort) {
  return std::max(by_effort.min, static_cast<int>(std::lround(effort * count)));
}

}  // namespace tofsmith
