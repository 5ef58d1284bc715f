// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Unit in which users write the value of a key, by the end of its name: "Hz" of "f_max_hz"; "" of
/// a plain number.
std::string_view unit_of_key(std::string_view name);

/// Speed of light in vacuum [m/s].
inline constexpr double speed_of_light_m_per_s = 299792458.0;

/// Depth at which the round trip takes one whole period [m]: c / (2 f0).
constexpr double unambiguous_range_m(double fundamental_frequency_hz) {
  return speed_of_light_m_per_s / (2.0 * fundamental_frequency_hz);
}

/// A delay of one period wraps to zero: the representative of `position` in [0, period).
double wrap(double position, double period);

/// Signed shortest way from `from` to `to` on a circle of length `period`, in [-period/2,
/// period/2).
double circular_difference(double to, double from, double period);

/// A number as text: rounded to so many significant digits, at least to a whole number, and
/// never a power of ten: "61.23", "0.0123", "175312". "nan", "inf" as they are.
std::string plain_number(double value, int digits);

/// A length in the unit that suits it: "0.0653" -> "65.3 mm", "1.25" -> "1.25 m".
std::string length_text(double metres);

/// "61.23 ± 0.45" of value / unit, with one standard error.
std::string estimate_text(const Estimate& estimate, double unit, int digits = 5);

/// An error in mm and its standard error.
std::string estimate_mm_text(const Estimate& error_m);

}  // namespace tofsmith
