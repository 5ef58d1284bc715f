// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Frame with the noise scale of the shortest exposure.
struct MergedExposures {
  RawFrames values;       ///< (1, H, W, K), raw values for any decoder
  Image<float> averaged;  ///< (H, W): measurements of the shortest exposure with equal variance

  /// View of both, valid while this object lives.
  RawView view() const;
};

/// @param field  name of the list in errors
/// @throws InvalidArgument unless there are 2 or more, each from 1 to 1e6, the shortest 1
void check_exposures(std::span<const double> exposures, const std::string& field);

/// Merges frames of a scene with several exposures (HDR) before decoding. Each pixel is the average
/// of the frames in which none of its measurements is saturated or invalid, weighted by the inverse
/// variance:
///   sum_f w_f y_f / e_f / sum_f w_f,  w_f = e_f^2 / (e_f shot + constant).
/// y_f are the electrons and e_f the exposure of frame f. shot is the shot noise variance at the
/// shortest exposure, or its lower bound if subtracted buckets hide the light. Pixels that are
/// saturated in all frames remain saturated; invalid ones become NaN.
/// @param frames     of the table's code; may be averages
/// @param exposures  relative to the shortest exposure, which is that of the table
/// @throws InvalidArgument as check_exposures(), or if sizes differ
void merge_exposures(std::span<const RawView> frames, std::span<const double> exposures,
                     const DecodingTable& table, MergedExposures& merged);

}  // namespace tofsmith
