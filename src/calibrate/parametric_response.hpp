// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// Significant part of a record.
struct ResponseWindow {
  Eigen::VectorXd values;            ///< of the response
  Eigen::VectorXd variance;          ///< of the record
  double background_variance = 0.0;  ///< of the level subtracted from a pulse
  bool differentiated = false;  ///< values[i] = s[i + 1] - s[i]: noise increases with frequency
  double time_step_s = 0.0;
  double start_time_s = 0.0;  ///< of values[0]
};

/// -3 dB bandwidth of the response, with the error from the noise of each value. NaN if it has none
/// below half the sampling rate.
Estimate measured_bandwidth_hz(const ResponseWindow& window);

struct DenoisedResponse {
  ImpulseResponse response;        ///< kind "file"
  double response_centre_s = 0.0;  ///< centre of gravity, from the first sample
  double centre_s = 0.0;           ///< centre of gravity in the record
  double noise_rms = 0.0;          ///< relative to the highest value
};

/// Applies a Wiener filter, centres the response on a sample and resamples it.
/// @param margin_s  extension of the window, into which the filter spreads
DenoisedResponse denoised_response(const ResponseWindow& window, double time_step_s,
                                   double margin_s);

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
