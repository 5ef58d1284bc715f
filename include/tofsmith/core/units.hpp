// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the unit of a key from the end of its name: "Hz" for "f_max_hz"; "" for plain numbers.
std::string_view unit_of_key(std::string_view name);

inline constexpr double speed_of_light_m_per_s = 299792458.0;

/// c / (2 f0), the depth at which the round trip takes one period.
constexpr double unambiguous_range_m(double fundamental_frequency_hz) {
  return speed_of_light_m_per_s / (2.0 * fundamental_frequency_hz);
}

/// Wraps to [0, period).
double wrap(double position, double period);

/// Signed shortest difference on a circle, in [-period/2, period/2).
double circular_difference(double to, double from, double period);

/// Formats a number with `digits` significant digits and all digits before the decimal point,
/// without exponent: "61.23", "0.0123", "175312", "nan", "inf".
std::string plain_number(double value, int digits);

/// "65.3 mm" for 0.0653, "1.25 m" for 1.25.
std::string length_text(double metres);

/// value / unit with its standard error: "61.23 ± 0.45".
std::string estimate_text(const Estimate& estimate, double unit, int digits = 5);

/// In mm, with the standard error.
std::string estimate_mm_text(const Estimate& error_m);

/// Reads a number with optional unit, such as "20MHz", "5 mm" or "2".
/// @param unit  as returned by unit_of_key(); also the unit of a number without one
/// @return the number in `unit`; none if the text is not a number or its unit is of another kind
std::optional<double> number_in_unit(std::string_view text, std::string_view unit);

/// Returns "a number, or one with its unit such as 2MHz", or "a number" without a unit.
std::string number_rule(std::string_view unit);

}  // namespace tofsmith
