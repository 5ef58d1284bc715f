// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "tofsmith/core/field_visitor.hpp"

namespace tofsmith {

enum class LightWaveform { square };
constexpr auto words_of(LightWaveform /*any*/) { return word_list("square"); }

/// Square waves that a sensor chip can generate for its light and its gates, which are open for
/// half of the period. Only for `design --method frequencies`.
struct SquareLight {
  LightWaveform waveform = LightWaveform::square;
  double duty = 0.5;
  std::vector<double> duties;                       ///< empty: only `duty`
  std::optional<std::array<double, 2>> duty_range;  ///< replaces a list
  std::optional<std::vector<double>> frequencies_hz;
  std::optional<double> clock_hz;
  std::optional<std::vector<int>> dividers;
  int phase_steps = 4;

  /// Returns frequencies_hz, or clock_hz divided by each divider, in ascending order.
  std::vector<double> modulation_frequencies_hz() const;

  /// @throws InvalidArgument
  void validate() const;

  friend bool operator==(const SquareLight&, const SquareLight&) = default;
};

/// Keys of square waves in [light].
inline void describe(FieldVisitor& fields, SquareLight& square) {
  fields.choice(Key("waveform", "Waveform that the chip generates for light and gates"),
                square.waveform);
  fields.value(Key("duty",
                   "Share of the period in which the square wave of the light is on; a list "
                   "contains all available values",
                   open(0, 1))
                   .usually(0.1, 0.5),
               NumberOrList{square.duty, square.duties});
  fields.value(Key("duty_range", "Smallest and largest duty, instead of a list", open(0, 1)),
               square.duty_range);
  fields.value(Key("frequencies_hz", "Available modulation frequencies", at_least(1e3)),
               square.frequencies_hz);
  fields.value(Key("clock_hz", "Clock that `dividers` divide, or upper limit of the frequencies",
                   at_least(1e3)),
               square.clock_hz);
  fields.value(Key("dividers", "Dividers of the clock, instead of frequencies_hz", closed(1, 1e6)),
               square.dividers);
  fields.value(
      Key("phase_steps", "Number of available phases per period of a frequency", closed(3, 64)),
      square.phase_steps);
}

}  // namespace tofsmith
