// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/calibrate/correlation_calibration.hpp"

namespace tofsmith {

/// A pixel whose nominal depth can be compared.
struct ReferenceSample {
  int frame = 0;
  int row = 0;
  int column = 0;
  double depth_m = 0.0;      ///< as the nominal code decodes it
  double reference_m = 0.0;  ///< what it should be
  double signal_e_per_s = 0.0;
  double deviation_m = 0.0;  ///< predicted, of depth_m
};

/// @throws std::invalid_argument unless the reference is one image or one per frame, of the frames'
/// size or 1 x 1
void require_same_size(const RawFrames& frames, const ReferenceDepth& reference);

/// Pixels of all frames, every so many rows and columns so that they are not too many.
std::vector<ReferenceSample> decoded_samples(const RawFrames& frames,
                                             const ReferenceDepth& reference,
                                             const DecodingTable& table, const Progress& progress);
/// The same.
/// @throws std::invalid_argument if fewer than 100 pixels can be compared
std::vector<ReferenceSample> reference_samples(const RawFrames& frames,
                                               const ReferenceDepth& reference,
                                               const DecodingTable& table,
                                               const Progress& progress);

/// Reference depth of a pixel [m]; NaN: not known, or outside the image.
double reference_at(const ReferenceDepth& reference, int frame, int row, int column);

/// depth - reference, wrapped into [-range / 2, range / 2).
double wrapped_difference_m(double difference_m, double range_m);

/// Whether delay runs backwards: the sum of both depths stays, not their difference.
/// @throws std::invalid_argument for a reference in another unit, flipped, or of something else
bool runs_backwards(const std::vector<ReferenceSample>& samples, const ReferenceDepth& reference,
                    int height, int width, double range_m);

/// By how many pixels the reference looks shifted against the frames; none: it fits as it is.
/// @param expected_m  of every sample its depth without what the fit explains
std::optional<std::string> shift_note(const std::vector<ReferenceSample>& samples,
                                      const ReferenceDepth& reference,
                                      const std::vector<double>& expected_m, double range_m,
                                      double scatter_m);

}  // namespace tofsmith
