// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "tofsmith/code/waveform.hpp"

namespace tofsmith {

/// An arbitrary waveform generator that drives one arm of a camera from a table of points. Its
/// analog bandwidth is not here: it belongs to the arm's impulse response.
struct Generator {
  double sample_rate_hz = 500e6;  ///< most points per second [1/s], > 0
  int amplitude_bits = 14;        ///< of a point's amplitude, 1 .. 24

  /// Points of one period, n: as many whole ones as the sample rate allows, n f0 <= sample rate.
  /// The clock is then n f0.
  int points_per_period(double fundamental_frequency_hz) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule; also where a period has
  ///         fewer than 2 points
  void validate(std::string_view field, double fundamental_frequency_hz) const;

  friend bool operator==(const Generator&, const Generator&) = default;
};

/// The points of a generator that is told a waveform, each held for 1/n of the period.
///   - A point takes the waveform's value at the middle of its time, as in a table that a user
///     loads. So a switching time moves to the nearest point, by at most half a point (from the
///     middle between two to the earlier one), and a pulse shorter than a point may vanish.
///   - Amplitudes are rounded to 2^bits levels from 0 to the waveform's own peak. On and off are
///     levels: a binary waveform stays binary, and one whose switching times are points does not
///     change.
/// @throws std::invalid_argument if the generator cannot play that frequency, or for values below 0
Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz);

/// Where a generator of n points per period puts a switching time [points], as `generated` does.
double nearest_point(double switching_time_periods, double points_per_period);

}  // namespace tofsmith
