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

/// Waveforms that drive the arms of a camera, before their impulse responses.
struct ActualCode {
  std::vector<Waveform> modulation;    ///< one per exposure, mean at most 1
  std::vector<Waveform> demodulation;  ///< one per tap value
};

/// Returns the waveforms that the camera's generators output for a code; nominal waveforms for an
/// arm without generator.
///   - A modulation whose mean after rounding exceeds 1 is scaled to 1, because the average power
///     is fixed. A mean below 1 is kept, because the peak may already be at its limit.
///   - With two taps and no drain, one generator drives the first tap, and the second tap has the
///     complement, 1 - d.
/// @throws InvalidArgument if the light's generator outputs no pulse of a modulation
ActualCode actual_code(const CodeSet& code, const Camera& camera);

/// Returns a waveform convolved with the impulse response of an arm, at t = j / points. Without
/// impulse response, returns averages over the cells [j, j + 1) / points.
Eigen::VectorXd arm_output(const Waveform& waveform, const ImpulseResponse& response,
                           double fundamental_frequency_hz, int points);

/// Arm of a camera.
enum class Arm { light, sensor };
constexpr std::string_view name_of(Arm arm) { return arm == Arm::light ? "light" : "sensor"; }

/// Nominal and actual properties of one waveform on its generator.
struct GeneratorReport {
  Arm arm = Arm::light;
  int index = 0;
  int points_per_period = 0;  ///< n
  double clock_hz = 0.0;      ///< n f0
  double duty_nominal = 0.0, duty_actual = 0.0;
  double mean_nominal = 0.0, mean_actual = 0.0;  ///< relative to average power, or gain
  double peak_nominal = 0.0, peak_actual = 0.0;
  int edges_nominal = 0, edges_actual = 0;
  double rms_difference = 0.0;
  std::optional<double> largest_edge_move_s;
};
auto fields_of(ConstOrNot<GeneratorReport> auto& r) {
  return std::tuple(Field("arm", r.arm, Help{"arm of the waveform: light or sensor"}),
                    Field("index", r.index, Help{"exposure (light) or tap value (sensor), from 0"}),
                    Field("points_per_period", r.points_per_period),
                    Field("clock_hz", r.clock_hz, Help{"points per second"}),
                    Field("duty_nominal", r.duty_nominal), Field("duty_actual", r.duty_actual),
                    Field("mean_nominal", r.mean_nominal), Field("mean_actual", r.mean_actual),
                    Field("peak_nominal", r.peak_nominal), Field("peak_actual", r.peak_actual),
                    Field("edges_nominal", r.edges_nominal), Field("edges_actual", r.edges_actual),
                    Field("rms_difference", r.rms_difference,
                          Help{"root mean square over the period of actual minus nominal "
                               "waveform"}),
                    Field("largest_edge_move_s", r.largest_edge_move_s,
                          Help{"largest displacement of a switching time; none for a waveform that "
                               "is not binary"}));
}

/// Returns one report per waveform of a generator, light first. Impulse responses are not included.
/// @throws InvalidArgument if the camera is invalid or cannot use the code
std::vector<GeneratorReport> generator_report(const CodeSet& code, const Camera& camera);

}  // namespace tofsmith
