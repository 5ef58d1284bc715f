// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <string>

namespace tofsmith {

/// Interval of numbers that a setting accepts. The default accepts every number, including NaN; the
/// functions below create others and check them at compile time.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool includes_low = true, includes_high = true;
  bool is_restricted = false;
  bool includes_infinity = false;  ///< although `high` is infinite

  bool contains(double value) const {
    if (!is_restricted) return true;
    if (std::isinf(value) && value > 0.0 && includes_infinity) return true;
    return std::isfinite(value) && (includes_low ? value >= low : value > low) &&
           (includes_high ? value <= high : value < high);
  }
  /// "finite and >= 0", "in (0, 1]", "finite"; for integers ">= 0".
  std::string text(bool is_integer = false) const;

  consteval Range or_infinity() const {
    Range range = *this;
    range.includes_infinity = true;
    return range;
  }
};

namespace detail {
consteval Range checked(Range range) {
  range.is_restricted = true;
  if (!(range.low < range.high)) throw "the lower end of a range must be below the upper end";
  return range;
}
}  // namespace detail

/// All numbers except NaN and infinity.
consteval Range finite() { return detail::checked({}); }
consteval Range at_least(double low) { return detail::checked({.low = low}); }
consteval Range above(double low) { return detail::checked({.low = low, .includes_low = false}); }
consteval Range closed(double low, double high) {
  return detail::checked({.low = low, .high = high});
}
consteval Range open(double low, double high) { return detail::checked({low, high, false, false}); }
consteval Range right_open(double low, double high) {
  return detail::checked({low, high, true, false});
}
consteval Range left_open(double low, double high) {
  return detail::checked({low, high, false, true});
}

}  // namespace tofsmith
