// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "decode/pixel_model.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/decoder.hpp"

namespace tofsmith {

/// What a decoder found out about one pixel.
struct PixelDecoding {
  double depth_bin = 0.0;  ///< in [0, N)
  PixelEstimate estimate;
  double confidence = 0.0;  ///< that no far-off depth is the true one
};

/// Writes one pixel, with its status, into an image that starts as invalid: what every decoder does
/// in the same way.
void store_pixel(const DecodingTable& table, const DecodeOptions& options, const float* raw,
                 const PixelDecoding& pixel, std::size_t at, DepthImage& image);

/// Normal probability that a lead is not noise of this deviation.
double confidence_of(double lead, double deviation);

/// Decodes one frame on all threads, with progress.
/// @param block_pixels  pixels of a block, at most
/// @param decode_block  is given the raw numbers of a block's first pixel, the block as indices of
///                      pixels, and the image to store them in
/// @throws std::invalid_argument if the shape does not fit; Interrupted if progress says so
DepthImage decode_frame(const RawFrames& raw, int frame, int measurements,
                        std::int64_t block_pixels, const Progress& progress,
                        const std::function<void(const float* raw, IndexRange pixels,
                                                 DepthImage& image)>& decode_block);

}  // namespace tofsmith
