// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

/// One harmonic of a measured table against that of an ideal code.
struct HarmonicRatio {
  int harmonic = 1;
  double measured = 0.0;  ///< amplitude, root of the sum of squares over measurements
  double ideal = 0.0;     ///< the same of the fitted code without responses
  Estimate ratio;         ///< what both arms pass of it; not a number where the code has none
};

/// An ideal code fitted to a measured table.
struct IdealCodeFit {
  std::string code;
  double delay_periods = 0.0;   ///< by which the measured curves arrive later
  bool reversed = false;        ///< delay runs the other way
  bool inverted = false;        ///< all signs are opposite
  std::vector<int> exposure;    ///< of the code that each measured exposure is
  double scale = 1.0;           ///< raw numbers of one unit of the code's correlation
  double ideal_residual = 0.0;  ///< rms left over the rms of the table, without responses
  double residual = 0.0;        ///< the same with the response
  ImpulseResponse response;     ///< of each of the two arms, both alike; none if nothing is gained
  Estimate parameter_hz;        ///< its f_max_hz or cutoff_hz
  Eigen::MatrixXd fitted;       ///< (N, K), without means
  std::vector<HarmonicRatio> harmonics;  ///< 1 .. 16
};

/// Fits codes to a measured table, the least residual first: common scale, delay, direction and
/// sign, the order of exposures, and one symmetric response of both arms (hann, gaussian or
/// lowpass), all by least squares over harmonics. Means of columns do not count.
/// @param table   (N, K)
/// @param error   standard errors of its values (N, K)
/// @param codes   families or codes that fit the camera's taps, of K values
/// @throws std::invalid_argument if no code has K values
std::vector<IdealCodeFit> fit_ideal_codes(const Eigen::MatrixXd& table,
                                          const Eigen::MatrixXd& error, const Camera& camera,
                                          const std::vector<CodeSet>& codes);

/// The ideal codes of K values on that camera: every family, without responses, peak or generator.
std::vector<CodeSet> ideal_codes(const Camera& camera, int measurements);

/// The camera whose arms respond as fitted and whose taps differ as measured.
Camera with_fit(Camera camera, const IdealCodeFit& fit,
                const std::vector<Estimate>& tap_mismatch = {});

}  // namespace tofsmith
