// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reference_bins.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith::benchmarks {

inline constexpr int pixels_per_kind = 4096;  ///< consecutive pixels

/// Generates raw values (pixels, K) that are difficult to decode: three noise levels, ambient light
/// 100 times the signal, light over six powers of ten, exactly half-way between two bins, whole
/// numbers, tiny and huge scales, only ambient light, NaN and infinity, and a mixture. The kind
/// changes every pixels_per_kind pixels.
/// @param raw  (pixels * K)
void fill_hard_pixels(const DecodingTable& table, std::uint64_t seed, int pixels, float* raw);

}  // namespace tofsmith::benchmarks
