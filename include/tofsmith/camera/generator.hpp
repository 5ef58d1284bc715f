// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

/// Waveform generator or pattern memory that drives one arm of a camera from a table of points. Its
/// bandwidth is part of the impulse response of the arm.
struct Generator {
  double sample_rate_hz = 500e6;
  int amplitude_bits = 14;
  /// Default: points_per_period(). Points are skipped if the sample rate allows fewer.
  std::optional<int> table_points = {};
  /// Default: edges may occur at any point.
  std::optional<double> edge_grid_s = {};

  /// Number of points output per period: the largest n with n f0 <= sample_rate_hz, at most
  /// table_points. The clock is n f0.
  int points_per_period(double fundamental_frequency_hz) const;
  int points_in_table(double fundamental_frequency_hz) const;

  /// @throws InvalidArgument with a field `field`.*
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
                   "Number of points in the table of one period; default: as many as are output "
                   "per period",
                   closed(2, 1048576)),
               generator.table_points);
  fields.value(Key("edge_grid_s",
                   "Time grid of the edges of binary waveforms; must divide the period", above(0)),
               generator.edge_grid_s);
}

/// Returns the table of one period of a nominal waveform. Each point is held for 1/n of the period.
///   - Switching times of binary waveforms are first moved to the edge grid, if any.
///   - Each point has the value of the waveform at its middle. A switching time moves to the
///     nearest point (ties: the earlier one), and pulses shorter than a point may vanish.
///   - Amplitudes are rounded to 2^bits levels from 0 to the peak. Binary waveforms stay binary.
/// @throws InvalidArgument if the generator does not support the frequency, or for negative values
Waveform generator_table(const Waveform& waveform, const Generator& generator,
                         double fundamental_frequency_hz);

/// Returns the output of a generator for a nominal waveform: its table, resampled at the middles of
/// the output points if it has more points than points_per_period().
/// @throws InvalidArgument as generator_table()
Waveform generated(const Waveform& waveform, const Generator& generator,
                   double fundamental_frequency_hz);

/// Returns a switching time as rounded by generated() [periods].
double generated_switching_time(double switching_time_periods, const Generator& generator,
                                double fundamental_frequency_hz);

/// Returns the point to which generator_table() moves a switching time without edge grid.
double nearest_point(double switching_time_periods, double points_per_period);

}  // namespace tofsmith
