// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/wrong_shares.hpp"

namespace tofsmith {

/// Errors with the light of other cameras at one operating point.
struct InterferencePoint {
  OperatingPoint point;
  double expected_rmse_m = 0.0;  ///< of DecodeMethod::zncc; infinite for uniform albedo
  Estimate linear_mde_m;
  Estimate circular_mde_m;
  Estimate circular_rmse_m;
  WrongShares shares;
};
auto fields_of(ConstOrNot<InterferencePoint> auto& p) {
  return std::tuple(
      Field("point", p.point, FieldMark::in_place),
      Field("expected_rmse_m", p.expected_rmse_m, at_least(0).or_infinity(),
            Help{"root mean square error of zncc with interference and noise, to first order in "
                 "both"}),
      Field("linear_mde_m", p.linear_mde_m, at_least(0), Help{"mean absolute error of trials"}),
      Field("circular_mde_m", p.circular_mde_m, at_least(0),
            Help{"the same for the circular (wrapped) error"}),
      Field("circular_rmse_m", p.circular_rmse_m, at_least(0),
            Help{"root mean square circular error of trials"}),
      Field("shares", p.shares, FieldMark::in_place));
}

/// Effect of the light of other cameras.
struct InterferenceReport {
  /// Root mean square error of DecodeMethod::zncc without noise, over depths, phases and frames of
  /// the other cameras, to first order in their light:
  ///   error = c / (2 f0) (g . y) / |g|^2,
  /// where y is the light of the other cameras in the measurements and g is the derivative of the
  /// expected measurements with respect to the phase of the depth [periods], without its components
  /// along the derivatives with respect to signal and ambient light.
  double rms_m = 0.0;
  DepthErrorMean linear, circular;
  WrongShares shares;
  std::vector<InterferencePoint> points;

  const DepthErrorMean& of(DepthErrorKind kind) const {
    return kind == DepthErrorKind::linear ? linear : circular;
  }
};
auto fields_of(ConstOrNot<InterferenceReport> auto& r) {
  return std::tuple(
      Field("rms_m", r.rms_m, at_least(0),
            Help{"root mean square error of zncc without noise, to first order in the light of the "
                 "others"}),
      Field("linear", r.linear, Help{"mean linear errors with noise, over the operating points"}),
      Field("circular", r.circular,
            Help{"mean circular errors with noise, over the operating points"}),
      Field("shares", r.shares, FieldMark::in_place, Help{"means over the operating points"}),
      Field("points", r.points));
}

/// Computes the depth error with the light of the other cameras in `operating.interference`, by
/// Monte Carlo simulation with the decoder of `options.method`, and in closed form.
///
/// Each exposure sees one exposure of every other camera, whose frame begins with a random
/// exposure. Harmonics of their light and of the demodulation whose frequencies differ by d are
/// multiplied by sinc(d T), where T is the exposure, or its part if it changes the phase of the
/// harmonic. Depths are drawn as by evaluate().
/// @param options  trials, seed, method and unwrap_weights are used
/// @throws InvalidArgument as evaluate(), or without operating.interference; Interrupted
/// @note same bits for any number of threads
InterferenceReport interference_error(const CodeSet& code, const Camera& camera,
                                      const EvaluateOptions& options = {},
                                      const Progress& progress = {});

}  // namespace tofsmith
