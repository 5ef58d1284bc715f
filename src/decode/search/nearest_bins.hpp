// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace tofsmith {

inline std::int32_t nearest_bin(double depth_bin, int samples) {
  return static_cast<std::int32_t>(std::lround(depth_bin)) % samples;
}

/// The bins nearest to the depths of a decoder; -1 where there is none.
template <typename AnyDecoder>
void nearest_bins(const AnyDecoder& decoder, const float* measurements, std::int64_t pixels,
                  std::int32_t* bin) {
  std::vector<double> position(static_cast<std::size_t>(pixels));
  decoder.decode_depth_bins(measurements, pixels, position.data());
  for (std::int64_t i = 0; i < pixels; ++i) {
    const double at = position[static_cast<std::size_t>(i)];
    bin[i] = std::isnan(at) ? -1 : nearest_bin(at, decoder.samples());
  }
}

}  // namespace tofsmith
