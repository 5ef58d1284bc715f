// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// The arm that plays a waveform.
enum class Arm { light, sensor };

/// Nominal and actual figures of one waveform on its generator.
struct GeneratorReport {
  Arm arm = Arm::light;
  int index = 0;              ///< exposure (light) or tap value (sensor), from 0
  int points_per_period = 0;  ///< n
  double clock_hz = 0.0;      ///< n f0: points per second
  double duty_nominal = 0.0, duty_actual = 0.0;
  double mean_nominal = 0.0, mean_actual = 0.0;  ///< power over average power, or gain
  double peak_nominal = 0.0, peak_actual = 0.0;
  int edges_nominal = 0, edges_actual = 0;
  /// Farthest that a switching time has moved [s]; none for a waveform that is not binary.
  std::optional<double> largest_edge_move_s;
  double rms_difference = 0.0;  ///< of actual and nominal over the period, in units of the waveform
};

/// One entry for every waveform that a generator of the camera plays, light first; empty without
/// generators. Impulse responses come after and are not in it.
/// @throws std::invalid_argument if the camera is invalid or the code does not fit it
std::vector<GeneratorReport> generator_report(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith
