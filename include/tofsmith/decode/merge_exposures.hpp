// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Result of merge_exposures(): one frame with the noise scale of the shortest exposure.
struct MergedExposures {
  RawFrames values;       ///< (1, H, W, K), raw values for any decoder
  Image<float> averaged;  ///< (H, W): measurements of the shortest exposure with equal variance

  /// View of both, valid while this object lives.
  RawView view() const;
};

/// Checks a list of exposures.
/// @param field  name of the list in errors
/// @throws std::invalid_argument unless there are 2 or more, each from 1 to 1e6, the shortest 1
void check_exposures(std::span<const double> exposures, const std::string& field);

/// Merges frames of a scene with several exposures (HDR) before decoding. Each pixel is the average
/// of the frames in which none of its measurements is saturated or invalid, weighted by the inverse
/// variance:
///   sum_f w_f y_f / e_f / sum_f w_f,  w_f = e_f^2 / (e_f shot + constant).
/// y_f are the electrons of frame f, e_f is its exposure divided by the shortest, and shot is the
/// shot noise variance at the shortest exposure, estimated from all valid frames. If subtracted
/// buckets hide the light, shot is its lower bound. Pixels that are saturated in all frames remain
/// saturated; pixels that are invalid in all frames become NaN.
/// @param frames     measurements of the table's code; may be averages
/// @param exposures  exposure of each frame divided by the shortest exposure, which is that of the
///   table
/// @throws std::invalid_argument as check_exposures(), or if sizes differ
/// @note the same bits for any number of threads
void merge_exposures(std::span<const RawView> frames, std::span<const double> exposures,
                     const DecodingTable& table, MergedExposures& merged);

}  // namespace tofsmith
