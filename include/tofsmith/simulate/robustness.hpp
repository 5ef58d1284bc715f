// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Deviations of a camera from its description, and parameters of the evaluation.
struct RobustnessOptions {
  double bandwidth = 0.2;
  double peak = 0.1;
  double edge_jitter_s = 50e-12;
  double tap_mismatch = 0.02;
  double clock_s = 0.0;
  double droop = 0.0;
  bool together = false;
  std::int64_t trials = 4000;
  std::uint64_t seed = 1;  ///< all cameras use the same depths and noise
  DecodeMethod method = DecodeMethod::zncc;
  UnwrapWeights unwrap_weights = UnwrapWeights::variance;

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<RobustnessOptions> auto& o) {
  return std::tuple(
      Field("bandwidth", o.bandwidth, right_open(0, 1),
            Help{"relative change of the arms' bandwidth; 0: skip"}),
      Field("peak", o.peak, right_open(0, 1), Help{"relative change of the peak power; 0: skip"}),
      Field("edge_jitter_s", o.edge_jitter_s, closed(0, 1),
            Help{"root mean square edge jitter of each arm; 0: skip"}),
      Field("tap_mismatch", o.tap_mismatch, right_open(0, 1),
            Help{"difference of neighbouring taps; 0: skip"}),
      Field("clock_s", o.clock_s, closed(0, 1), Help{"grid of the switching times; 0: skip"}),
      Field("droop", o.droop, right_open(0, 1),
            Help{"sag of the light within half a period; 0: skip"}),
      Field("together", o.together, Help{"also evaluate a camera with all changes at once"}),
      Field("trials", o.trials, closed(2, 4e9), Help{"trials per operating point"}),
      Field("seed", o.seed, Help{"seed of all trials"}),
      Field("method", o.method, decode_method_help),
      Field("unwrap_weights", o.unwrap_weights, unwrap_weights_help, unwrap_weights_condition));
}

/// A camera that deviates from its description.
struct PerturbedCamera {
  std::string name;      ///< "bandwidth -20 %", ...
  Camera camera;         ///< with its changed limits; used with perturbed_code()
  double peak = 1.0;     ///< peak power relative to the description
  double clock_s = 0.0;  ///< grid of switching times [s]; 0: none
  double droop = 0.0;    ///< sag of the light within half a period
};

/// Returns cameras with one change each, at the same light levels and average power:
/// - bandwidth: all frequencies of both arms' impulse responses are scaled (measured responses are
///   stretched in time); omitted if no arm has one,
/// - peak: peak power is scaled, see perturbed_code(),
/// - edge jitter: added in quadrature to the jitter of each arm, independently (common jitter would
///   cancel),
/// - tap mismatch: added to the camera's; omitted if the sum would reach 1,
/// - clock: switching times of both arms are rounded to a clock, see perturbed_code(),
/// - droop: the light sags while it is on, see perturbed_code(),
/// - together: all changes at once, with lower bandwidth and peak.
std::vector<PerturbedCamera> perturbations(const Camera& camera,
                                           const RobustnessOptions& options = {});

/// Returns a code as emitted and received by a perturbed camera, at the same average power.
/// - Binary modulation: the level is multiplied by `peak` and the length of every pulse divided by
///   it, about its centre. Pulses that would overlap merge, which loses the overlapping light;
///   pulses that would fill the period stay on.
/// - Sampled modulation: deviations from the mean are scaled so that the peak changes by the factor
///   `peak`; negative values are clipped, and the result is scaled to the old mean, which slightly
///   reduces the peak. If even the mean would exceed the new peak, the modulation is dimmed.
///
/// A clock then moves every switching time of both arms to its nearest point (a whole number of
/// points per period), as generated(); modulation above the average power is dimmed. Finally,
/// binary light with droop decays as exp(-t / s) from every rise, with s such that half a period
/// reduces it to 1 - droop; power is lost. It is stored as means over the code's samples. Other
/// light has no plateaus and is not changed by droop. Demodulation changes only by the clock.
/// @throws std::invalid_argument if the clock has fewer than 2 points per period or leaves a
///         modulation dark
CodeSet perturbed_code(const CodeSet& code, const PerturbedCamera& perturbed);

/// Depth error on a perturbed camera: geometric mean over its operating points [m].
struct PerturbedError {
  std::string name;
  /// With a decoder that knows the perturbed camera. Equal to uncalibrated_m if the code cannot
  /// measure depth on that camera, e.g. because mismatched taps let ambient light through.
  Estimate calibrated_m;
  Estimate uncalibrated_m;  ///< with a decoder that assumes the described camera
};
auto fields_of(ConstOrNot<PerturbedError> auto& e) {
  return std::tuple(Field("name", e.name),
                    Field("calibrated_m", e.calibrated_m, at_least(0), FieldMark::as_object,
                          InDocuments{"calibrated"}),
                    Field("uncalibrated_m", e.uncalibrated_m, at_least(0), FieldMark::as_object,
                          InDocuments{"uncalibrated"}));
}

/// Depth error of a code on a camera and on its perturbations.
struct RobustnessReport {
  DepthErrorKind kind = DepthErrorKind::linear;  ///< of all errors, from the operating range
  std::int64_t trials = 0;                       ///< per operating point
  std::uint64_t seed = 0;
  Estimate nominal_m;  ///< on the camera as described
  std::vector<PerturbedError> perturbed;

  /// Largest error, including the nominal one [m].
  Estimate worst_calibrated_m() const;
  Estimate worst_uncalibrated_m() const;
};
auto fields_of(ConstOrNot<RobustnessReport> auto& r) {
  return std::tuple(
      Field("kind", r.kind, InDocuments{"error"}), Field("trials", r.trials), Field("seed", r.seed),
      Field("nominal_m", r.nominal_m, at_least(0), FieldMark::as_object, InDocuments{"nominal"}),
      Field("perturbed", r.perturbed, InDocuments{"perturbations"}));
}

/// Evaluates a code on the perturbations of its camera. Perturbations that lead to a code that the
/// camera does not support are omitted, e.g. pulses too short for the light's generator.
/// @throws std::invalid_argument if the camera or the options are invalid, the code does not fit or
///         the method cannot decode it; Interrupted if `progress` cancels
/// @note same bits for any number of threads
RobustnessReport robustness(const CodeSet& code, const Camera& camera,
                            const RobustnessOptions& options = {}, const Progress& progress = {});

/// Effect of the limits of a camera's generators on a code. All three errors use the same depths
/// and noise, without bounds.
struct GeneratorLoss {
  DepthErrorReport nominal;       ///< on the camera without generators
  DepthErrorReport actual;        ///< with generators and a decoder for the actual waveforms
  DepthErrorReport uncalibrated;  ///< with generators and a decoder for the nominal waveforms
  /// RMS difference of nominal and actual correlation functions, per measurement (K), relative to
  /// the RMS of the nominal one about its mean.
  std::vector<double> correlation_change;

  /// Geometric mean over the operating points [m].
  Estimate nominal_m(DepthErrorKind kind) const { return nominal.of(kind).geometric_mean_m; }
  /// actual / nominal
  double ratio(DepthErrorKind kind) const;
  /// uncalibrated / nominal
  double uncalibrated_ratio(DepthErrorKind kind) const;
};

/// @param camera  with generators; without them the waveforms are nominal
/// @throws std::invalid_argument as evaluate(); Interrupted if `progress` cancels
/// @note same bits for any number of threads
GeneratorLoss generator_loss(const CodeSet& code, const Camera& camera,
                             const EvaluateOptions& options = {}, const Progress& progress = {});

}  // namespace tofsmith
