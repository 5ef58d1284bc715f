// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Arbitrary waveform generator, or pattern memory, that drives one arm of a camera from a table of
/// points. Its analog bandwidth belongs to the impulse response of the arm.
struct Generator {
  double sample_rate_hz = 500e6;
  int amplitude_bits = 14;
  /// Points of the table that contains one period; none: as many as are played. If the table has
  /// more points than the sample rate allows, some are skipped.
  std::optional<int> table_points = {};
  /// Binary waveforms switch only at multiples of this time, which divides the period [s]; none: at
  /// any point.
  std::optional<double> edge_grid_s = {};

  /// Number of points of one period that are played, n: the largest integer with
  /// n f0 <= sample_rate_hz, limited by table_points. The clock is then n f0.
  int points_per_period(double fundamental_frequency_hz) const;
  /// Number of points of the table that contains one period.
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
                   "Points of the table that contains one period; without it, as "
                   "many as are played",
                   closed(2, 1048576)),
               generator.table_points);
  fields.value(Key("edge_grid_s",
                   "Time grid of the edges of binary waveforms, which divides the "
                   "period",
                   above(0)),
               generator.edge_grid_s);
}

/// Table of one period of a nominal waveform in a generator; each point is held for 1/n of the
/// period.
///   - Switching times of a binary waveform first move to the edge grid, if there is one.
///   - A point has the value of the waveform at the middle of its time. A switching time thereby
///     moves to the nearest point, by at most half a point (from the middle between two points to
///     the earlier one), and a pulse shorter than a point may vanish.
///   - Amplitudes are rounded to 2^bits levels from 0 to the peak of the waveform. A binary
///   waveform
///     stays binary, and does not change if its switching times are points.
/// @throws std::invalid_argument if the generator cannot play that frequency, or for values below 0
Waveform generator_table(const Waveform& waveform, const Generator& generator,
                         double fundamental_frequency_hz);

/// Waveform that a generator plays for a nominal one: its table or, of a table with more points
/// than are played, the points at the middles of those that are played.
/// @throws std::invalid_argument as generator_table()
Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz);

/// Switching time that generated() makes of a switching time [periods].
double generated_switching_time(double switching_time_periods, const Generator& generator,
                                double fundamental_frequency_hz);

/// Point to which generator_table() moves a switching time without an edge grid [points].
double nearest_point(double switching_time_periods, double points_per_period);

}  // namespace tofsmith
