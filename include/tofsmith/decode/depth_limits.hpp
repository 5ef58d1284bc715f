// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

/// Smallest and largest radial depth of a frame after all corrections.
struct DepthLimits {
  double min_m = 0.0;
  double max_m = 0.0;

  bool contains(double depth_m) const { return depth_m >= min_m && depth_m <= max_m; }
  /// Returns too_near or too_far for a depth outside the limits.
  PixelStatus status_of(double depth_m) const {
    return depth_m < min_m ? PixelStatus::too_near : PixelStatus::too_far;
  }
};

/// Returns the limits for decoding: `min_depth_m` and `max_depth_m`. An absent one is replaced by
/// the camera's working distance, or by the end of the range if there is none. Returns none if all
/// three are absent.
/// @throws std::invalid_argument naming the field, unless 0 <= minimum < maximum <= range
std::optional<DepthLimits> depth_limits(const DecodingTable& table,
                                        std::optional<double> min_depth_m,
                                        std::optional<double> max_depth_m);

/// Restricts decoded pixels to depths within the limits. Pixels with a confidence below 1 are
/// decoded again with the depths within the limits as the only candidates
/// (DepthDecoder::decode_within). A pixel without such a candidate, or whose depth lies outside
/// with a probability of at least 0.9, is too_near or too_far. The status saturated, low_signal or
/// inconsistent is kept; the depth is NaN in any case.
///
/// Must be called before apply(DepthCorrection) and apply(PixelMaps), whose effect it takes into
/// account. remove_outside() must be called after these.
/// @param decoder  decoder of the planes
/// @param raw      numbers of the same pixels as `decoded`
/// @param maps     maps of the whole frame, of `width` columns
/// @param first    index in the frame of the first pixel of `raw`
/// @param decoded  depth, confidence and status are required
/// @throws std::invalid_argument if a required plane is null; Interrupted if `progress` requests it
/// @note the same bits for any number of threads
void restrict_depths(const DepthLimits& limits, const DepthDecoder& decoder, const RawView& raw,
                     const PixelMaps& maps, int width, std::size_t first,
                     const DecodedView& decoded, const Progress& progress = {});

/// Removes the depth of pixels whose corrected depth is outside the limits, with the same statuses
/// as restrict_depths().
/// @param decoded  depth and status are required
void remove_outside(const DepthLimits& limits, const DecodedView& decoded, std::size_t count);

}  // namespace tofsmith
