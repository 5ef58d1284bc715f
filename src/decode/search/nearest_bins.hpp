// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tofsmith {

inline std::int32_t nearest_bin(double depth_bin, int samples) {
  return static_cast<std::int32_t>(std::lround(depth_bin)) % samples;
}

/// Bins nearest to the depths of a decoder; -1 without depth.
template <typename AnyDecoder>
void nearest_bins(const AnyDecoder& decoder, const float* measurements, std::int64_t pixels,
                  std::int32_t* bin) {
  constexpr std::int64_t block = 512;
  double position[block];
  for (std::int64_t done = 0; done < pixels; done += block) {
    const std::int64_t count = std::min(pixels - done, block);
    decoder.decode_depth_bins(measurements + done * decoder.measurements(), count, position);
    for (std::int64_t i = 0; i < count; ++i)
      bin[done + i] = std::isnan(position[i]) ? -1 : nearest_bin(position[i], decoder.samples());
  }
}

}  // namespace tofsmith
