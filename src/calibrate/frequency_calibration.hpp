// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"

namespace tofsmith {

/// Offset, contrast and harmonics of every frequency of a code.
struct FrequencyCalibration {
  Eigen::MatrixXd correlation;                   ///< (N, K), with the harmonics found
  std::vector<CalibratedFrequency> frequencies;  ///< by increasing frequency
  std::vector<double> offsets_m, contrasts;      ///< as CalibratedDepth
  bool reversed = false;                         ///< delay runs backwards
  std::vector<std::string> notes;                ///< of parameters that the frames do not determine
};

/// Calibrates every frequency of a code against depth along the ray.
///   1. Phases of the frequencies, by least squares over the fundamentals in each pixel, give
///      offsets and contrasts. They need no unwrapping.
///   2. Deviations b from the camera's correlation functions,
///        chi_i(z) + 2 |c_i| sum_h Re(b_h exp(i h (arg c_i + 2 pi n z / range))),
///      where c_i is the fundamental of measurement i and n its frequency in units of f0, minimise
///      the weighted squares of the measurements with signal and ambient light of each pixel
///      eliminated (variable projection). b_1 is the error of offset and contrast. A weak prior,
///      the smaller the higher the harmonic, decides where the frames do not. Pixels that
///      do not fit have no weight (Tukey's biweight).
///   3. Standard errors from tiles of pixels, whose errors may be correlated.
/// @return  none if the code has a single frequency, or its phases do not agree with the reference
std::optional<FrequencyCalibration> calibrate_frequencies(const RawFrames& frames,
                                                          const ReferenceDepth& reference,
                                                          const CodeSet& code,
                                                          const Camera& camera);

}  // namespace tofsmith
