// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

/// The actual waveforms of a code: what drives the arms of a camera, ahead of their impulse
/// responses.
struct ActualCode {
  std::vector<Waveform> modulation;    ///< one per exposure, mean at most 1
  std::vector<Waveform> demodulation;  ///< one per tap value
};

/// What the camera's generators make of a code; the nominal waveforms where an arm has none.
///   - Rounding may lengthen the pulses of a modulation. The source's average power is fixed: above
///     a mean of 1 the whole waveform is scaled down. Below, it is left as it is, since the peak
///     may be at its limit: the light is then less than nominal.
///   - A sensor of two taps without drain has one generator, which plays the first tap; the second
///     is what the first leaves, 1 - d.
/// @throws std::invalid_argument if a modulation has no pulse that the generator can play
ActualCode actual_code(const CodeSet& code, const Camera& camera);

/// Output of an arm that is driven with a waveform: the waveform convolved with the arm's impulse
/// response, at t = j / points, j = 0 .. points - 1. Without response: averages over the cells [j,
/// j + 1) / points.
Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points);

/// The arm that plays a waveform.
enum class Arm { light, sensor };
/// "light", "sensor".
constexpr std::string_view name_of(Arm arm) { return arm == Arm::light ? "light" : "sensor"; }

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
  double rms_difference = 0.0;  ///< of actual and nominal over the period, in units of the waveform
  /// Farthest that a switching time has moved [s]; none for a waveform that is not binary.
  std::optional<double> largest_edge_move_s;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<GeneratorReport> auto& r) {
  return std::tuple(Field("arm", r.arm), Field("index", r.index),
                    Field("points_per_period", r.points_per_period), Field("clock_hz", r.clock_hz),
                    Field("duty_nominal", r.duty_nominal), Field("duty_actual", r.duty_actual),
                    Field("mean_nominal", r.mean_nominal), Field("mean_actual", r.mean_actual),
                    Field("peak_nominal", r.peak_nominal), Field("peak_actual", r.peak_actual),
                    Field("edges_nominal", r.edges_nominal), Field("edges_actual", r.edges_actual),
                    Field("rms_difference", r.rms_difference),
                    Field("largest_edge_move_s", r.largest_edge_move_s));
}

/// One entry for every waveform that a generator of the camera plays, light first; empty without
/// generators. Impulse responses come after and are not in it.
/// @throws std::invalid_argument if the camera is invalid or the code does not fit it
std::vector<GeneratorReport> generator_report(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith
