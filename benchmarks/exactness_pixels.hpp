// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reference_curve.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith::benchmarks {

inline constexpr int pixels_per_kind = 4096;  ///< that come one after another

/// Raw numbers (pixels, K) that a decoder may find hard, from a stream named by `seed`: the three
/// noise levels, ambient light 100 times the signal, light over six powers of ten, exactly half-way
/// between two bins, whole numbers, tiny and huge scales, ambient light alone, no numbers at all,
/// and all of these mixed. Kinds change every pixels_per_kind pixels.
/// @param raw  (pixels * K)
void fill_hard_pixels(const DecodingTable& table, std::uint64_t seed, int pixels, float* raw);

}  // namespace tofsmith::benchmarks
