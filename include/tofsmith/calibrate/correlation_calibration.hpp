// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/calibrate/delay_sweep.hpp"
#include "tofsmith/core/array.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/measured_table.hpp"
#include "tofsmith/decode/pixel_maps.hpp"

namespace tofsmith {

/// What is known of the camera that took a sweep.
struct CorrelationCalibrationOptions {
  int taps = 1;                ///< columns hold the taps of an exposure side by side
  bool differences = false;    ///< columns are differences of taps
  double range_m = 10.0;       ///< depth of a whole period [m], > 0
  Eigen::VectorXd exposure_s;  ///< T [s] (K), if they differ; else empty
  double black_level = 0.0;    ///< raw number without light, where there are no dark frames
  RawFrames dark;              ///< frames with the light off, or none
  std::optional<float> saturation_level;  ///< raw numbers from here on are clipped
  Image<float> geometry_m;  ///< depth of the flat target in each pixel less that on the axis [m];
                            ///< empty: none is taken out of the offset map

  /// @throws std::invalid_argument naming field, value and rule
  void validate(const DelaySweep& sweep) const;
};

/// Pixels left out, each counted once, by the first reason that holds.
struct DeadPixels {
  int not_a_number = 0;  ///< NaN or infinity in some frame
  int constant = 0;      ///< the same number in all frames
  int saturated = 0;     ///< clipped in some frame
  int low = 0;           ///< responds with less than a tenth of the usual
  int total() const { return not_a_number + constant + saturated + low; }
};

/// What a sweep tells of a camera.
struct CalibratedCorrelation {
  MeasuredTable table;             ///< of the usual pixel, its gain 1 and its offset 0
  Eigen::MatrixXd standard_error;  ///< of each value of the table (N, K)
  PixelMaps maps;                  ///< of each pixel; empty for a table of means
  double delay_error_m = 0.0;      ///< standard error of a usual pixel's offset [m]
  double gain_error = 0.0;         ///< of its gain
  DeadPixels dead;
  bool drift_known = false;            ///< some delay was measured more than once
  bool drift_corrected = false;        ///< and what was found is beyond 3 standard errors
  Estimate light_drift;                ///< change of the light over the sweep, as a share
  Estimate level_drift;                ///< change of the level over the sweep [raw numbers]
  std::vector<Estimate> tap_mismatch;  ///< of each exposure of two taps, as Sensor::tap_mismatch
  double noise_rms = 0.0;              ///< of one raw number [raw numbers]
  std::string noise_source;            ///< "pixels", "repeats" or "high harmonics"
  std::vector<std::string> notes;
};

/// The measured table of a sweep.
///   1. Dead pixels are left out.
///   2. Drift: delays measured more than once tell how light and level changed in time, taken to be
///      straight lines; what is beyond 3 standard errors is taken out.
///   3. Every pixel's curve is taken apart into harmonics; its delay and gain against the mean
///      curve maximize the sum over harmonics and measurements (the least squares fit), and the
///      mean curve is made again of the pixels so aligned, until neither changes.
///   4. Table: the aligned mean at N equally spaced places of the period, N as many as there were.
///      Errors from what the fits leave, place by place.
/// The mean gain is 1 and the mean offset 0.
/// @throws std::invalid_argument if sweep or options are invalid, or no live pixel is left
CalibratedCorrelation calibrate_correlation(const DelaySweep& sweep,
                                            const CorrelationCalibrationOptions& options,
                                            const Progress& progress = {});

}  // namespace tofsmith
