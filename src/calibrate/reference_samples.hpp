// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"

namespace tofsmith {

/// Pixel to compare with the reference.
struct ReferenceSample {
  int frame = 0;
  int row = 0;
  int column = 0;
  double depth_m = 0.0;  ///< with the nominal code
  double reference_m = 0.0;
  double signal_e_per_s = 0.0;
  double deviation_m = 0.0;  ///< predicted for depth_m
};

/// @throws std::invalid_argument unless the reference is one image or one per frame, of the frames'
///         size or 1 x 1
void require_same_size(const RawFrames& frames, const ReferenceDepth& reference);

/// Decodes a subset of the pixels of all frames.
std::vector<ReferenceSample> decoded_samples(const RawFrames& frames,
                                             const ReferenceDepth& reference,
                                             const DecodingTable& table, const Progress& progress);
/// As decoded_samples(). @throws std::invalid_argument if there are fewer than 100
std::vector<ReferenceSample> reference_samples(const RawFrames& frames,
                                               const ReferenceDepth& reference,
                                               const DecodingTable& table,
                                               const Progress& progress);

/// Reference depth [m]; NaN if unknown or outside the image.
double reference_at(const ReferenceDepth& reference, int frame, int row, int column);

/// Wraps into [-range / 2, range / 2).
double wrapped_difference_m(double difference_m, double range_m);

/// Returns true if the sum of both depths is constant, not their difference.
/// @throws std::invalid_argument for a reference in another unit, flipped, or of another scene
bool runs_backwards(const std::vector<ReferenceSample>& samples, const ReferenceDepth& reference,
                    int height, int width, double range_m);

/// Describes the shift of the reference in pixels; none if it is aligned.
/// @param expected_m  depth of every sample minus the fitted error
std::optional<std::string> shift_note(const std::vector<ReferenceSample>& samples,
                                      const ReferenceDepth& reference,
                                      const std::vector<double>& expected_m, double range_m,
                                      double scatter_m);

}  // namespace tofsmith
