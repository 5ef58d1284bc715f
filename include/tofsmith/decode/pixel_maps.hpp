// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/depth_image.hpp"

namespace tofsmith {

/// What differs from pixel to pixel of a sensor, of the size of its frames. A map left empty is not
/// applied; NaN in a map marks a dead pixel.
struct PixelMaps {
  Image<float> delay_offset_m;  ///< (H, W): by how much a pixel decodes too far [m], any sign
  Image<float> gain;            ///< (H, W): response of a pixel over that of a usual one, > 0

  bool empty() const { return delay_offset_m.empty() && gain.empty(); }
  /// @throws std::invalid_argument naming the map, its size and the frames', or the pixel that is
  ///         infinite or not > 0
  void validate(int height, int width) const;
};

/// Corrects decoded pixels first .. first + count - 1 (row by row) in place: depth becomes depth -
/// offset, wrapped into [0, range); signal and ambient are divided by the gain. Confidence and
/// deviation stay, because shot noise is that of the electrons seen, and so do bins, which say
/// which row of the table fits. Dead pixels become invalid, without depth.
/// @param maps     valid for the frame
/// @param range_m  of the decoding table [m]
/// @param decoded  planes whose first value is that of pixel `first`
/// @throws std::invalid_argument if the pixels do not lie within a map
void apply(const PixelMaps& maps, double range_m, const DecodedView& decoded, std::size_t first,
           std::size_t count);

}  // namespace tofsmith
