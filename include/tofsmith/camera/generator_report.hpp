// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// The arm that plays a waveform.
enum class Arm { light, sensor };

/// What a generator makes of one waveform it is told to play.
struct GeneratorReport {
  Arm arm = Arm::light;
  int index = 0;              ///< exposure (light) or tap value (sensor), from 0
  int points_per_period = 0;  ///< n
  double clock_hz = 0.0;      ///< n f0: points per second
  double duty_told = 0.0, duty_played = 0.0;
  double mean_told = 0.0, mean_played = 0.0;  ///< power over average power, or gain
  double peak_told = 0.0, peak_played = 0.0;
  int edges_told = 0, edges_played = 0;
  /// Farthest that a switching time has moved [s]; none for a waveform that is not binary.
  std::optional<double> largest_edge_move_s;
  double rms_difference = 0.0;  ///< of played and told over the period, in units of the waveform
};

/// One entry for every waveform that a generator of the camera plays, light first; empty without
/// generators. Impulse responses come after and are not in it.
/// @throws std::invalid_argument if the camera is invalid or the code does not fit it
std::vector<GeneratorReport> generator_report(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith
