// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// Significant part of a record, as an impulse response.
struct ResponseWindow {
  Eigen::VectorXd values;            ///< of the response, 0 outside
  Eigen::VectorXd variance;          ///< of the values of the record
  double background_variance = 0.0;  ///< of the level subtracted from a pulse
  bool differentiated = false;  ///< values[i] = s[i + 1] - s[i]: noise increases with frequency
  double time_step_s = 0.0;     ///< [s]
  double start_time_s = 0.0;    ///< of values[0] [s]
};

/// Computes the -3 dB bandwidth of the windowed response. Its error is propagated from the noise of
/// each value. NaN if the response has no such frequency below half the sampling rate.
Estimate measured_bandwidth_hz(const ResponseWindow& window);

/// Denoised, centred and resampled response.
struct DenoisedResponse {
  ImpulseResponse response;        ///< kind "file"
  double response_centre_s = 0.0;  ///< centre of gravity, from the first sample [s]
  double centre_s = 0.0;           ///< centre of gravity in the record [s]
  double noise_rms = 0.0;          ///< remaining noise, relative to the highest value
};

/// Applies a Wiener filter, centres the response on a sample and resamples it to `time_step_s`.
/// @param margin_s  extension of the window, into which the filter spreads [s]
DenoisedResponse denoised_response(const ResponseWindow& window, double time_step_s,
                                   double margin_s);

}  // namespace tofsmith
