// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Arbitrary waveform generator or pattern memory that drives one arm of a camera from a table of
/// points. Its analog bandwidth is part of the impulse response of the arm.
struct Generator {
  double sample_rate_hz = 500e6;
  int amplitude_bits = 14;
  /// Number of points in the table of one period; none: points_per_period(). If the sample rate
  /// allows fewer points, some points of the table are skipped.
  std::optional<int> table_points = {};
  /// Time grid [s] of the edges of binary waveforms; must divide the period. None: edges may occur
  /// at any point.
  std::optional<double> edge_grid_s = {};

  /// Number of points output per period, n: the largest integer with n f0 <= sample_rate_hz, but at
  /// most table_points. The clock is n f0.
  int points_per_period(double fundamental_frequency_hz) const;
  /// Number of points in the table of one period.
  int points_in_table(double fundamental_frequency_hz) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule
  void validate(std::string_view field, double fundamental_frequency_hz) const;

  friend bool operator==(const Generator&, const Generator&) = default;
};

/// Keys of [light.generator] and [sensor.generator].
inline void describe(FieldVisitor& fields, Generator& generator) {
  fields.value(Key("sample_rate_hz", "Maximum number of points per second", above(0)),
               generator.sample_rate_hz);
  fields.value(Key("amplitude_bits", "Resolution of the amplitude", closed(1, 24)),
               generator.amplitude_bits);
  fields.value(Key("table_points",
                   "Number of points in the table of one period; without it, the number of "
                   "points output per period",
                   closed(2, 1048576)),
               generator.table_points);
  fields.value(Key("edge_grid_s",
                   "Time grid of the edges of binary waveforms; must divide the period", above(0)),
               generator.edge_grid_s);
}

/// Returns the table of one period of a nominal waveform. Each point is held for 1/n of the period.
///   - If there is an edge grid, switching times of a binary waveform are first moved to it.
///   - Each point has the value of the waveform at its middle. A switching time therefore moves to
///     the nearest point, by at most half a point (ties: the earlier point). Pulses shorter than a
///     point may vanish.
///   - Amplitudes are rounded to 2^bits levels from 0 to the peak of the waveform. Binary waveforms
///     stay binary; they are unchanged if their switching times coincide with points.
/// @throws std::invalid_argument if the generator does not support the frequency, or for negative
///   values
Waveform generator_table(const Waveform& waveform, const Generator& generator,
                         double fundamental_frequency_hz);

/// Returns the waveform that a generator outputs for a nominal one: its table, resampled at the
/// middles of the output points if the table has more points than points_per_period().
/// @throws std::invalid_argument as generator_table()
Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz);

/// Returns the switching time after generated() has rounded it [periods].
double generated_switching_time(double switching_time_periods, const Generator& generator,
                                double fundamental_frequency_hz);

/// Returns the point to which generator_table() moves a switching time without edge grid [points].
double nearest_point(double switching_time_periods, double points_per_period);

}  // namespace tofsmith
