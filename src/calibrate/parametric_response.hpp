// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// Record of a rising pulse or step.
struct ResponseFitProblem {
  Excitation excitation = Excitation::pulse;
  Eigen::VectorXd values;
  Eigen::VectorXd weights;  ///< 1 / variance, up to a common factor
  double time_step_s = 0.0;
  double place_s = 0.0;  ///< approximate peak or half step, from the first value
  double width_s = 0.0;  ///< approximate full width at half maximum
};

/// Fits position, width, height and background by weighted least squares (Levenberg-Marquardt with
/// three initial widths), in the units of the values. Values of pulses are averages over a sample.
/// @param kind  hann, gaussian or lowpass
ParametricResponse fit_parametric_response(ImpulseResponse::Kind kind,
                                           const ResponseFitProblem& problem);

}  // namespace tofsmith
