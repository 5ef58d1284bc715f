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

/// How far a camera may be from what it is said to be, and how its depth error is then measured.
struct RobustnessOptions {
  double bandwidth = 0.2;
  double peak = 0.1;
  double edge_jitter_s = 50e-12;
  double tap_mismatch = 0.02;
  double clock_s = 0.0;
  double droop = 0.0;
  bool together = false;
  std::int64_t trials = 4000;
  std::uint64_t seed = 1;  ///< every camera sees the same depths and noise
  DecodeMethod method = DecodeMethod::zncc;
  UnwrapWeights unwrap_weights = UnwrapWeights::variance;

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};
auto fields_of(ConstOrNot<RobustnessOptions> auto& o) {
  return std::tuple(
      Field("bandwidth", o.bandwidth, right_open(0, 1),
            Help{"relative change of the arms' bandwidth; 0: leave out"}),
      Field("peak", o.peak, right_open(0, 1),
            Help{"relative change of the peak power; 0: leave out"}),
      Field("edge_jitter_s", o.edge_jitter_s, closed(0, 1),
            Help{"root mean square edge jitter of each arm; 0: leave out"}),
      Field("tap_mismatch", o.tap_mismatch, right_open(0, 1),
            Help{"difference of neighbouring taps; 0: leave out"}),
      Field("clock_s", o.clock_s, closed(0, 1), Help{"grid of the switching times; 0: leave out"}),
      Field("droop", o.droop, right_open(0, 1),
            Help{"sag of the light within half a period; 0: leave out"}),
      Field("together", o.together, Help{"also judge one camera with all changes at once"}),
      Field("trials", o.trials, closed(2, 4e9), Help{"trials per operating point"}),
      Field("seed", o.seed, Help{"seed of all trials"}),
      Field("method", o.method, decode_method_help),
      Field("unwrap_weights", o.unwrap_weights, unwrap_weights_help, unwrap_weights_condition));
}

/// A camera that is not quite what it was said to be.
struct PerturbedCamera {
  std::string name;      ///< "bandwidth -20 %", ..
  Camera camera;         ///< with its own limits; plays perturbed_code()
  double peak = 1.0;     ///< its peak power over that it was said to have
  double clock_s = 0.0;  ///< grid of its switching times [s]; 0: none
  double droop = 0.0;    ///< sag of its light within half a period
};

/// The camera with one thing changed at a time, light levels and average power kept:
///   - bandwidth: every frequency of both arms' impulse responses scaled (measured responses are
///     stretched in time); left out where no arm has one,
///   - peak: peak power scaled, see perturbed_code(),
///   - edge jitter: added in quadrature to that of each arm, independent in both (a common one
///     would cancel),
///   - tap mismatch: added to that of the camera; left out where it would reach 1,
///   - clock: switching times of both arms on the points of a clock, see perturbed_code(),
///   - droop: the light sags while it is on, see perturbed_code(),
///   - together: all of these at once, bandwidth and peak lowered.
std::vector<PerturbedCamera> perturbations(const Camera& camera,
                                           const RobustnessOptions& options = {});

/// What a perturbed source makes of a code at the same average power.
///   - Binary modulation: the level is multiplied by `peak` and every pulse's length divided by it,
///     about its centre. Pulses that so come to overlap merge, at the loss of the light that would
///     have been twice; pulses that would fill the period stay on.
///   - Sampled modulation: deviations from its mean are scaled so that its peak is `peak` times
///     what it was; what falls below 0 is cut, and the whole scaled to the old mean (its peak is
///     then a little less). Where even the mean would exceed the new peak, the whole is dimmed.
/// Then a clock moves every switching time of both arms to its nearest point, a whole number of
/// them per period, as generated() does; what so comes to emit more than the average power is
/// dimmed. Last, binary light that droops falls off as exp(-t / s) from every rise on, with the s
/// at which half a period takes it to 1 - droop; power is lost. It is then kept as means over the
/// code's samples. Light that is not binary has no plateaus and stays. Demodulation changes by the
/// clock alone. Without any of the three it is the code itself.
/// @throws std::invalid_argument if the clock has fewer than 2 points or leaves a modulation dark
CodeSet perturbed_code(const CodeSet& code, const PerturbedCamera& perturbed);

/// Depth error on a perturbed camera: geometric mean over its operating points [m].
struct PerturbedError {
  std::string name;
  /// By a decoder that knows the perturbed camera; where the code measures no depth on that camera,
  /// for example because mismatched taps let ambient light through, as uncalibrated_m.
  Estimate calibrated_m;
  Estimate uncalibrated_m;  ///< by one that believes the camera to be what it was said to be
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<PerturbedError> auto& e) {
  return std::tuple(Field("name", e.name),
                    Field("calibrated_m", e.calibrated_m, at_least(0), FieldMark::as_object,
                          InDocuments{"calibrated"}),
                    Field("uncalibrated_m", e.uncalibrated_m, at_least(0), FieldMark::as_object,
                          InDocuments{"uncalibrated"}));
}

/// Depth error of a code when its camera is not quite what it was said to be.
struct RobustnessReport {
  DepthErrorKind kind = DepthErrorKind::linear;  ///< of all errors, as the camera's operating range
  std::int64_t trials = 0;                       ///< made, per operating point
  std::uint64_t seed = 0;
  Estimate nominal_m;  ///< on the camera as it was said to be
  std::vector<PerturbedError> perturbed;

  /// The largest error, the nominal one included [m].
  Estimate worst_calibrated_m() const;
  Estimate worst_uncalibrated_m() const;
};
/// Its fields (core/fields.hpp).
auto fields_of(ConstOrNot<RobustnessReport> auto& r) {
  return std::tuple(
      Field("kind", r.kind, InDocuments{"error"}), Field("trials", r.trials), Field("seed", r.seed),
      Field("nominal_m", r.nominal_m, at_least(0), FieldMark::as_object, InDocuments{"nominal"}),
      Field("perturbed", r.perturbed, InDocuments{"perturbations"}));
}

/// Judges a code on the perturbations of its camera. Perturbations that change the code to one that
/// the camera cannot use are left out, such as pulses too short for the light's generator.
/// @throws std::invalid_argument if the camera or the options are invalid, the code does not fit or
///         the method cannot decode it; Interrupted if progress says so
/// @note same bits for any number of threads
RobustnessReport robustness(const CodeSet& code, const Camera& camera,
                            const RobustnessOptions& options = {}, const Progress& progress = {});

/// What the limits of a camera's generators do to a code. All three errors are of the same depths
/// and the same noise, without bounds.
struct GeneratorLoss {
  DepthErrorReport nominal;       ///< on the camera without generators
  DepthErrorReport actual;        ///< with them, by a decoder that knows the actual waveforms
  DepthErrorReport uncalibrated;  ///< with them, by a decoder that assumes the nominal waveforms
  /// Rms difference of the nominal and actual correlation functions, per measurement (K), over the
  /// rms of the nominal one about its mean.
  std::vector<double> correlation_change;

  /// Geometric mean over the operating points [m], of the kind the camera is judged by.
  Estimate nominal_m(DepthErrorKind kind) const { return nominal.of(kind).geometric_mean_m; }
  /// actual / nominal
  double ratio(DepthErrorKind kind) const;
  /// uncalibrated / nominal
  double uncalibrated_ratio(DepthErrorKind kind) const;
};

/// @param camera  with generators; the camera without them has the nominal waveforms
/// @throws std::invalid_argument as evaluate(); Interrupted if progress says so
/// @note same bits for any number of threads
GeneratorLoss generator_loss(const CodeSet& code, const Camera& camera,
                             const EvaluateOptions& options = {}, const Progress& progress = {});

}  // namespace tofsmith
