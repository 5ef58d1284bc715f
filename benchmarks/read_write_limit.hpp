// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "decode_frame.hpp"

namespace tofsmith::benchmarks {

/// Reads every raw value and writes every value of the requested planes, a few thousand pixels at a
/// time: the minimum work of a decoder.
inline void read_and_write(const std::vector<float>& raw, int measurements,
                           const DecodedView& planes) {
  constexpr int block = 4096;
  const int pixels = static_cast<int>(raw.size()) / measurements;
  for (int first = 0; first < pixels; first += block) {
    const int count = std::min(block, pixels - first);
    const float* numbers = raw.data() + static_cast<std::ptrdiff_t>(first) * measurements;
    std::uint32_t seen = 0;
    for (int i = 0; i < count * measurements; ++i) {
      std::uint32_t bits;
      std::memcpy(&bits, numbers + i, sizeof bits);
      seen |= bits;
    }
    const auto value = static_cast<std::int32_t>(seen >> 9);
    for_each_plane(
        [&]<typename Value>(Value* plane) {
          if (plane != nullptr)
            std::fill_n(plane + first, count,
                        static_cast<Value>(std::is_enum_v<Value> ? value & 1 : value));
        },
        planes);
    asm volatile("" ::: "memory");
  }
}

}  // namespace tofsmith::benchmarks
