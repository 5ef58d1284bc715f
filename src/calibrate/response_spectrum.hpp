// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/calibrate/impulse_response.hpp"

namespace tofsmith {

/// The part of a record that stands out of its noise, as an impulse response.
struct ResponseWindow {
  Eigen::VectorXd values;            ///< of the response, 0 outside
  Eigen::VectorXd variance;          ///< of each value of the record behind them
  double background_variance = 0.0;  ///< of the level that was taken off a pulse
  bool differentiated = false;       ///< values[i] = s[i + 1] - s[i]: noise grows with frequency
  double time_step_s = 0.0;          ///< [s]
  double start_time_s = 0.0;         ///< of values[0] [s]
};

/// -3 dB bandwidth of the windowed response itself, its error propagated from the noise of every
/// value; not a number where it passes more than that up to half the sampling rate.
Estimate measured_bandwidth_hz(const ResponseWindow& window);

/// The response without its noise, centred and resampled.
struct DenoisedResponse {
  ImpulseResponse response;        ///< kind "file"
  double response_centre_s = 0.0;  ///< its centre of gravity, from its first sample [s]
  double centre_s = 0.0;           ///< the same in the record [s]
  double noise_rms = 0.0;          ///< left, over the highest value
};

/// Wiener's filter, then the centre of gravity on a sample, in steps of `time_step_s`.
/// @param margin_s  how far to look beyond the window, into which the filter spreads [s]
DenoisedResponse denoised_response(const ResponseWindow& window, double time_step_s,
                                   double margin_s);

}  // namespace tofsmith
