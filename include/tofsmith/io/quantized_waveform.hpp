// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/code/waveform.hpp"

namespace tofsmith {

/// One waveform as the table of a generator, or the memory of an FPGA, holds it: whole numbers, one
/// for each point. This is what every writer of a waveform format takes.
struct QuantizedWaveform {
  std::string name;         ///< of letters, digits and _, begins with a letter: "modulation_1"
  Arm arm = Arm::light;     ///< that plays it
  int index = 0;            ///< exposure (light) or tap value (sensor), from 0
  std::int32_t levels = 2;  ///< codes run from 0 to levels - 1; 2 .. 2^24
  std::vector<std::int32_t> codes;  ///< of `periods` periods, one after another
  int periods = 1;                  ///< >= 1; divides the number of codes
  double sample_rate_hz = 0.0;      ///< points of the table per second, > 0
  double full_scale = 1.0;          ///< value of the waveform at the largest code: power over
                                    ///< average power, or gain; code 0 is a value of 0
  double low_v = 0.0;               ///< what code 0 shall come out as [V]
  double high_v = 1.0;              ///< what the largest code shall come out as [V], > low_v

  int points() const { return static_cast<int>(codes.size()); }
  int points_per_period() const { return points() / periods; }
  /// How often per second the whole table is played.
  double repetition_hz() const { return sample_rate_hz / points(); }
  /// How far it is from one code to the next, in units of the waveform.
  double step() const { return full_scale / (levels - 1); }
  /// Value of a code, in units of the waveform.
  double value_of(std::int32_t code) const { return step() * code; }
  double volts_of(std::int32_t code) const {
    return low_v + (high_v - low_v) * code / (levels - 1);
  }
  double amplitude_vpp() const { return high_v - low_v; }
  double offset_v() const { return 0.5 * (low_v + high_v); }

  /// The first half of every period, in which the trigger is on.
  bool trigger_at(int point) const {
    return point % points_per_period() < (points_per_period() + 1) / 2;
  }

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;

  friend bool operator==(const QuantizedWaveform&, const QuantizedWaveform&) = default;
};

/// The nearest of `levels` codes for the value at each point of a waveform that is constant over
/// points: differs by at most half a step. Name, volts and rate are left to the caller.
/// @param table   what generator_table() gives, of `points` points
/// @param scale   multiplies the waveform; the full scale is its peak times this
QuantizedWaveform quantized(const Waveform& table, int points, std::int32_t levels,
                            double scale = 1.0);

}  // namespace tofsmith
