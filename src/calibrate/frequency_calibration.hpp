// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"

namespace tofsmith {

struct FrequencyCalibration {
  Eigen::MatrixXd correlation;                   ///< (N, K)
  std::vector<CalibratedFrequency> frequencies;  ///< increasing
  std::vector<double> offsets_m, contrasts;
  bool reversed = false;           ///< delay increases in the opposite direction
  std::vector<std::string> notes;  ///< on undetermined parameters
};

/// Calibrates each frequency of a code against radial reference depth.
///   1. Compute the phasor of each frequency and pixel by least squares over the fundamentals. The
///      phases give offsets, the lengths contrasts, without phase unwrapping.
///   2. Fit deviations b from the correlation functions of the camera,
///        chi_i(z) + 2 |c_i| sum_h Re(b_h exp(i h (arg c_i + 2 pi n z / range))),
///      where c_i is the fundamental of measurement i and n its frequency in units of f0, by
///      weighted least squares with signal and ambient light of each pixel eliminated (variable
///      projection). b_1 is the error of offset and contrast. A weak prior, narrower for higher
///      harmonics, determines the rest. Outliers have zero weight (Tukey's biweight).
///   3. Compute standard errors from tiles of pixels, within which errors may be correlated.
/// @return  none if the code has a single frequency, or its phases do not agree with the reference
std::optional<FrequencyCalibration> calibrate_frequencies(const RawFrames& frames,
                                                          const ReferenceDepth& reference,
                                                          const CodeSet& code,
                                                          const Camera& camera);

}  // namespace tofsmith
