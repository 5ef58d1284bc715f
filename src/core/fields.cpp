// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/fields.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/shared/text_numbers.hpp"

namespace tofsmith {

std::string error_name(std::string_view name) {
  for (const std::string_view end : {"_m", "_mde"})
    if (name.ends_with(end)) name.remove_suffix(end.size());
  return std::string(name) + "_se_m";
}

bool keeps(double value, std::string_view rule) {
  const auto drop = [&rule](std::string_view beginning) {
    const bool there = rule.starts_with(beginning);
    if (there) rule.remove_prefix(beginning.size());
    return there;
  };
  const auto number = [&rule, &drop] {
    const double found = take_number(rule).value();
    return drop("/") ? found / take_number(rule).value() : found;
  };
  if (drop("0 or ") && value == 0.0) return true;
  if (drop("finite") && !std::isfinite(value)) return false;
  drop(" and ");
  if (rule.empty()) return true;
  if (drop(">= ")) return value >= number();
  if (drop("> ")) return value > number();
  const bool above_low = drop("in (");
  if (!above_low) drop("in [");
  const double low = number();
  drop(", ");
  const double high = number();
  const bool holds =
      (above_low ? value > low : value >= low) && (rule == ")" ? value < high : value <= high);
  const bool is_understood = rule == ")" || rule == "]";
  TOFSMITH_ASSERT_EQ(is_understood, true);
  return holds;
}

int scaled_count(int count, double effort, ByEffort by_effort) {
  return std::max(by_effort.min, static_cast<int>(std::lround(effort * count)));
}

}  // namespace tofsmith
