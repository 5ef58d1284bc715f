// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// A record to which parametric responses are fitted; it rises.
struct ResponseFitProblem {
  Excitation excitation = Excitation::pulse;
  Eigen::VectorXd values;
  Eigen::VectorXd weights;   ///< 1 / variance, up to a common factor
  double time_step_s = 0.0;  ///< [s]
  double place_s = 0.0;      ///< of the peak or of half the step, from the first value, roughly [s]
  double width_s = 0.0;      ///< full width at half maximum of the response, roughly [s]
};

/// Weighted least squares over place, width, height and background, by Levenberg-Marquardt from
/// three widths. Pulses are taken as averages over a sample. fit and residual_rms are in the units
/// of the values.
/// @param kind  hann, gaussian or lowpass
ParametricResponse fit_parametric_response(ImpulseResponse::Kind kind,
                                           const ResponseFitProblem& problem);

}  // namespace tofsmith
