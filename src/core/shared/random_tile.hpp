// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tofsmith {

/// A multiple of any vector length.
inline constexpr int trials_per_tile = 256;

/// Streams RandomStream(seed, work_item, first_trial + i) of a tile.
struct TrialStreams {
  std::uint64_t seed = 0;
  std::uint64_t work_item = 0;
  std::uint32_t first_trial = 0;
};

/// Words 4 block to 4 block + 3 of every stream, equal to the words of RandomStream (the first
/// operator() call returns word 0).
/// @param trials  1 to trials_per_tile; up to a multiple of 16 more are written
/// @param words   [4][trials_per_tile], 64-byte aligned
void draw_words(const TrialStreams& streams, std::uint32_t block, int trials, std::uint32_t* words);

/// Two standard normals per trial (Box-Muller in single precision) from all 32 bits of `radius`, so
/// that deviations reach 6.6, and the upper 24 bits of `angle`.
/// @param first, second  [trials_per_tile], 64-byte aligned; `first` must not be `radius`
void normals_of(const std::uint32_t* radius, const std::uint32_t* angle, int trials, float* first,
                float* second);

/// Exact Poisson counts, one per stream and `draw`: by inversion for means below 10, else by
/// transformed rejection (PTRS), whose words are disjoint from the words of blocks below 2^30.
/// @param draw   0 to 4095
/// @param mean   [trials_per_tile], finite; the count is 0 if <= 0
/// @param count  [trials_per_tile]
void draw_poisson(const TrialStreams& streams, int draw, int trials, const double* mean,
                  double* count);

}  // namespace tofsmith
