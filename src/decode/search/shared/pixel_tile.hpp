// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "decode/ambient_projection.hpp"

namespace tofsmith {

/// A multiple of any vector length.
inline constexpr int pixels_per_tile = 256;

struct PixelTile {
  int pixels = 0;
  /// [K][pixels_per_tile].
  alignas(64) float raw[max_measurements * pixels_per_tile];
  /// q = V^T y' [e], [rank][pixels_per_tile].
  alignas(64) float plane[max_measurements * pixels_per_tile];
  /// Bound on the error of `plane` [e]; NaN or infinite if a raw value is.
  alignas(64) float error[pixels_per_tile];
  /// Best bin in [0, N); -1 if unknown.
  alignas(64) std::int32_t bin[pixels_per_tile];
};

}  // namespace tofsmith
