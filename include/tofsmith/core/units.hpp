// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace tofsmith {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

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

}  // namespace tofsmith
