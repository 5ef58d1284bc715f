// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// Record of a rising pulse or step for parametric fits.
struct ResponseFitProblem {
  Excitation excitation = Excitation::pulse;
  Eigen::VectorXd values;
  Eigen::VectorXd weights;   ///< 1 / variance, up to a common factor
  double time_step_s = 0.0;  ///< [s]
  double place_s = 0.0;      ///< approximate time of peak or half step, from the first value [s]
  double width_s = 0.0;      ///< approximate full width at half maximum of the response [s]
};

/// Fits position, width, height and background by weighted least squares (Levenberg-Marquardt with
/// three initial widths). Values of pulses are averages over a sample. fit and residual_rms are in
/// the units of the values.
/// @param kind  hann, gaussian or lowpass
ParametricResponse fit_parametric_response(ImpulseResponse::Kind kind,
                                           const ResponseFitProblem& problem);

}  // namespace tofsmith
