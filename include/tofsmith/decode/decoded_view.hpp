// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/decode/return_status.hpp"

namespace tofsmith {

/// Where a decoder writes: planes of H x W values, row by row, in the caller's memory. A null plane
/// is not wanted, and what only it needs is not computed. Owns nothing.
struct DecodedView {
  std::int32_t* bin = nullptr;       ///< as decode_bins of the decoder: in [0, N), or -1
  float* depth_m = nullptr;          ///< as the planes of DepthImage
  float* signal_e_per_s = nullptr;   ///< [e/s]
  float* ambient_e_per_s = nullptr;  ///< [e/s]
  float* confidence = nullptr;       ///< in [0, 1]
  float* predicted_standard_deviation_m = nullptr;  ///< [m]
  PixelStatus* status = nullptr;
  // Of decoders of several returns; others leave them as they are.
  float* delay_m = nullptr;  ///< as the planes of MultipathImage
  float* ratio = nullptr;
  ReturnStatus* returns = nullptr;

  bool wants_bins_only() const;
  /// All planes of an image; no bins.
  static DecodedView of(DepthImage& image);
  /// The same planes from a later pixel on.
  DecodedView from(std::size_t pixel) const;
};

}  // namespace tofsmith
