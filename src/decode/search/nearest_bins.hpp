// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace tofsmith {

inline std::int32_t nearest_bin(double depth_bin, int samples) {
  return static_cast<std::int32_t>(std::lround(depth_bin)) % samples;
}

}  // namespace tofsmith
