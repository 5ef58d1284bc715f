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

/// Deviations of a camera from its description.
struct RobustnessOptions {
  double bandwidth = 0.2;
  double peak = 0.1;
  double edge_jitter_s = 50e-12;
  double tap_mismatch = 0.02;
  double clock_s = 0.0;
  double droop = 0.0;
  bool together = false;
  std::int64_t trials = 4000;
  std::uint64_t seed = 1;
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
  Camera camera;         ///< with its changed limits; for perturbed_code()
  double peak = 1.0;     ///< relative to the description
  double clock_s = 0.0;  ///< grid of switching times; 0: none
  double droop = 0.0;    ///< sag within half a period
};

/// Returns cameras with one change each, at the same light levels and average power
/// (docs/robustness.md), then one with all changes, lower bandwidth and lower peak. Bandwidth is
/// omitted without impulse responses, tap mismatch if the sum would reach 1. Jitter is added in
/// quadrature to the jitter of each arm, because common jitter would cancel.
std::vector<PerturbedCamera> perturbations(const Camera& camera,
                                           const RobustnessOptions& options = {});

/// Returns a code as emitted and received by a perturbed camera, at the same average power.
/// - Binary modulation: the level is multiplied by `peak` and the length of every pulse divided by
///   it, about its centre. Overlapping pulses merge and lose light; pulses that would fill the
///   period stay on.
/// - Sampled modulation: deviations from the mean are scaled so that the peak changes by `peak`;
///   negative values are clipped and the mean is restored. If even the mean would exceed the new
///   peak, the modulation is dimmed.
///
/// A clock then moves every switching time to its nearest point, as generated(); modulation above
/// the average power is dimmed. Finally, binary light with droop decays as exp(-t/s) from every
/// rise, with s such that half a period reduces it to 1 - droop; power is lost. Demodulation
/// changes only by the clock.
/// @throws std::invalid_argument if the clock has fewer than 2 points per period or leaves a
///         modulation dark
CodeSet perturbed_code(const CodeSet& code, const PerturbedCamera& perturbed);

/// Geometric mean of the depth error over the operating points [m].
struct PerturbedError {
  std::string name;
  /// Equal to uncalibrated_m if the code cannot measure depth on the perturbed camera, e.g. because
  /// mismatched taps pass ambient light.
  Estimate calibrated_m;
  Estimate uncalibrated_m;
};
auto fields_of(ConstOrNot<PerturbedError> auto& e) {
  return std::tuple(
      Field("name", e.name, Help{"perturbations"}),
      Field("calibrated_m", e.calibrated_m, at_least(0), FieldMark::as_object,
            InDocuments{"calibrated"},
            Help{"error for each perturbation, with a decoder that knows the perturbation"}),
      Field("uncalibrated_m", e.uncalibrated_m, at_least(0), FieldMark::as_object,
            InDocuments{"uncalibrated"},
            Help{"the same with a decoder for the camera as described"}));
}

/// Depth error of a code on perturbed cameras.
struct RobustnessReport {
  DepthErrorKind kind = DepthErrorKind::linear;
  std::int64_t trials = 0;
  std::uint64_t seed = 0;
  Estimate nominal_m;
  std::vector<PerturbedError> perturbed;

  /// Largest error, including the nominal one [m].
  Estimate worst_calibrated_m() const;
  Estimate worst_uncalibrated_m() const;
};
auto fields_of(ConstOrNot<RobustnessReport> auto& r) {
  return std::tuple(Field("kind", r.kind, InDocuments{"error"},
                          Help{"error of the camera's operating range: linear or circular"}),
                    Field("trials", r.trials, Help{"trials per operating point"}),
                    Field("seed", r.seed),
                    Field("nominal_m", r.nominal_m, at_least(0), FieldMark::as_object,
                          InDocuments{"nominal"}, Help{"error on the camera as described"}),
                    Field("perturbed", r.perturbed, InDocuments{"perturbations"}));
}

/// Evaluates a code on the perturbations of its camera, except for perturbed codes that the camera
/// does not support, e.g. pulses too short for the light's generator.
/// @throws std::invalid_argument as evaluate(); Interrupted
RobustnessReport robustness(const CodeSet& code, const Camera& camera,
                            const RobustnessOptions& options = {}, const Progress& progress = {});

/// Effect of the camera's generators on a code; all errors use the same depths and noise.
struct GeneratorLoss {
  DepthErrorReport nominal;       ///< without generators
  DepthErrorReport actual;        ///< with a decoder for the actual waveforms
  DepthErrorReport uncalibrated;  ///< with a decoder for the nominal waveforms
  /// RMS change of the correlation functions (K), relative to the RMS of the nominal ones about
  /// their means.
  std::vector<double> correlation_change;

  /// Geometric mean over the operating points [m].
  Estimate nominal_m(DepthErrorKind kind) const { return nominal.of(kind).geometric_mean_m; }
  /// actual / nominal
  double ratio(DepthErrorKind kind) const;
  /// uncalibrated / nominal
  double uncalibrated_ratio(DepthErrorKind kind) const;
};

/// @throws std::invalid_argument as evaluate(); Interrupted
GeneratorLoss generator_loss(const CodeSet& code, const Camera& camera,
                             const EvaluateOptions& options = {}, const Progress& progress = {});

}  // namespace tofsmith
