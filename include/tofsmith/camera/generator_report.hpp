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

/// Actual waveforms of a code, which drive the arms of a camera (before their impulse responses).
struct ActualCode {
  std::vector<Waveform> modulation;    ///< one per exposure, mean at most 1
  std::vector<Waveform> demodulation;  ///< one per tap value
};

/// Returns the waveforms that the camera's generators output for a code. An arm without generator
/// has the nominal waveforms.
///   - Rounding may lengthen the pulses of a modulation. Since the average power of the source is
///     fixed, a waveform with a mean above 1 is scaled to a mean of 1. A mean below 1 is kept,
///     because the peak may already be at its limit; the light is then less than nominal.
///   - A sensor with two taps and no drain has one generator, which drives the first tap. The
///     second tap has the complement, 1 - d.
/// @throws std::invalid_argument if the light's generator outputs no pulse of a modulation
ActualCode actual_code(const CodeSet& code, const Camera& camera);

/// Returns the output of an arm that is driven with a waveform: the waveform convolved with the
/// impulse response of the arm, at t = j / points, j = 0 ... points - 1. Without impulse response,
/// returns averages over the cells [j, j + 1) / points.
Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points);

/// Arm of a camera.
enum class Arm { light, sensor };
/// "light", "sensor".
constexpr std::string_view name_of(Arm arm) { return arm == Arm::light ? "light" : "sensor"; }

/// Nominal and actual properties of one waveform on its generator.
struct GeneratorReport {
  Arm arm = Arm::light;
  int index = 0;              ///< exposure (light) or tap value (sensor), from 0
  int points_per_period = 0;  ///< n
  double clock_hz = 0.0;      ///< n f0: points per second
  double duty_nominal = 0.0, duty_actual = 0.0;
  double mean_nominal = 0.0, mean_actual = 0.0;  ///< relative to average power, or gain
  double peak_nominal = 0.0, peak_actual = 0.0;
  int edges_nominal = 0, edges_actual = 0;
  double rms_difference = 0.0;  ///< actual minus nominal over one period, in units of the waveform
  /// Largest displacement of a switching time [s]; none for waveforms that are not binary.
  std::optional<double> largest_edge_move_s;
};
/// Fields of GeneratorReport (see core/fields.hpp).
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

/// Returns one report per waveform that a generator of the camera outputs, light first; empty
/// without generators. Impulse responses are not included.
/// @throws std::invalid_argument if the camera is invalid or cannot use the code
std::vector<GeneratorReport> generator_report(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith
