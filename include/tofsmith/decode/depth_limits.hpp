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

/// Smallest and largest radial depth after all corrections.
struct DepthLimits {
  double min_m = 0.0;
  double max_m = 0.0;

  bool contains(double depth_m) const { return depth_m >= min_m && depth_m <= max_m; }
  /// Returns too_near or too_far for a depth outside the limits.
  PixelStatus status_of(double depth_m) const {
    return depth_m < min_m ? PixelStatus::too_near : PixelStatus::too_far;
  }
};

/// Returns the limits for decoding. An absent one is replaced by the camera's working distance, or
/// by the end of the range. Returns none if all are absent.
/// @throws InvalidArgument unless 0 <= minimum < maximum <= range
std::optional<DepthLimits> depth_limits(const DecodingTable& table,
                                        std::optional<double> min_depth_m,
                                        std::optional<double> max_depth_m);

/// Restricts decoded pixels to depths within the limits. Pixels with a confidence below 1 are
/// decoded again with DepthDecoder::decode_within(); without a depth within the limits they become
/// too_near or too_far, or keep saturated, low_signal or inconsistent without depth.
///
/// Must be called before apply(DepthCorrection) and apply(PixelMaps), whose effect it takes into
/// account, and remove_outside() after them.
/// @param maps     of the whole frame, with `width` columns
/// @param first    index in the frame of the first pixel of `raw`
/// @param decoded  of the same pixels as `raw`; depth, confidence and status are required
/// @throws InvalidArgument if a required plane is null
void restrict_depths(const DepthLimits& limits, const DepthDecoder& decoder, const RawView& raw,
                     const PixelMaps& maps, int width, std::size_t first,
                     const DecodedView& decoded, const Progress& progress = {});

/// Removes corrected depths outside the limits.
/// @param decoded  depth and status are required
void remove_outside(const DepthLimits& limits, const DecodedView& decoded, std::size_t count);

}  // namespace tofsmith
