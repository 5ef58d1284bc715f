// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "tofsmith/code/waveform.hpp"

namespace tofsmith {

/// An arbitrary waveform generator, or a memory of patterns, that drives one arm of a camera from a
/// table of points. Its analog bandwidth is not here: it belongs to the arm's impulse response.
struct Generator {
  double sample_rate_hz = 500e6;  ///< most points per second [1/s], > 0
  int amplitude_bits = 14;        ///< of a point's amplitude, 1 .. 24
  /// Points of the table that holds one period, 2 .. 2^20; none: as many as are played. A table of
  /// more points than the sample rate allows is played by skipping some.
  std::optional<int> table_points = {};
  /// Binary waveforms switch at multiples of this time only [s]; it divides the period. None: at
  /// any point.
  std::optional<double> edge_grid_s = {};

  /// Points of one period that are played, n: as many whole ones as the sample rate allows,
  /// n f0 <= sample rate, and as the table has. The clock is then n f0.
  int points_per_period(double fundamental_frequency_hz) const;
  /// Points of the table that holds one period.
  int points_in_table(double fundamental_frequency_hz) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule; also where a period has
  ///         fewer than 2 points
  void validate(std::string_view field, double fundamental_frequency_hz) const;

  friend bool operator==(const Generator&, const Generator&) = default;
};

/// What a generator's table holds of a waveform it is told, each point held for 1/n of the period.
///   - Switching times of a binary waveform first move to the edge grid, if there is one.
///   - A point takes the waveform's value at the middle of its time, as in a table that a user
///     loads. So a switching time moves to the nearest point, by at most half a point (from the
///     middle between two to the earlier one), and a pulse shorter than a point may vanish.
///   - Amplitudes are rounded to 2^bits levels from 0 to the waveform's own peak. On and off are
///     levels: a binary waveform stays binary, and one whose switching times are points does not
///     change.
/// @throws std::invalid_argument if the generator cannot play that frequency, or for values below 0
Waveform generator_table(const Waveform& waveform, const Generator& generator,
                         double fundamental_frequency_hz);

/// What a generator makes of a waveform it is told: its table; of a table of more points than it
/// plays, the points at the middles of those it plays.
/// @throws std::invalid_argument as generator_table()
Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz);

/// Where `generated` puts a switching time [periods].
double generated_switching_time(double switching_time_periods, const Generator& generator,
                                double fundamental_frequency_hz);

/// Where a generator of n points per period puts a switching time [points], as `generator_table`
/// does without an edge grid.
double nearest_point(double switching_time_periods, double points_per_period);

}  // namespace tofsmith
