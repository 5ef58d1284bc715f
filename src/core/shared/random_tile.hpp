// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tofsmith {

/// Trials whose random numbers are drawn together; a multiple of any vector length.
inline constexpr int trials_per_tile = 256;

/// The streams RandomStream(seed, work_item, first_trial + i) of a tile of trials.
struct TrialStreams {
  std::uint64_t seed = 0;
  std::uint64_t work_item = 0;
  std::uint32_t first_trial = 0;
};

/// Words 4 block .. 4 block + 3 of every stream, Philox4x32-10 in vectors, word for word those of
/// RandomStream (the first operator() call gives word 0).
/// @param trials  1 .. trials_per_tile; up to a multiple of 16 more are written
/// @param words   [4][trials_per_tile], 64-byte aligned
void draw_words(const TrialStreams& streams, std::uint32_t block, int trials, std::uint32_t* words);

/// Two standard normals of every trial from two words each (Box-Muller in single precision): all
/// 32 bits of `radius`, so that deviations reach 6.6, and the upper 24 of `angle`.
/// @param first, second  [trials_per_tile], 64-byte aligned; `first` may not be `radius`
void normals_of(const std::uint32_t* radius, const std::uint32_t* angle, int trials, float* first,
                float* second);

/// Numbers of events of Poisson processes, one of each stream and of each `draw`, exact: inversion
/// for means below 10, else transformed rejection from as many words as it takes, which stand apart
/// from those of blocks below 2^30.
/// @param draw   0 .. 4095
/// @param mean   [trials_per_tile], finite; nothing arrives where it is <= 0
/// @param count  [trials_per_tile]
/// @see Hoermann, "The transformed rejection method for generating Poisson random variables",
///      Insurance: Mathematics and Economics 12, 1993 (PTRS)
void draw_poisson(const TrialStreams& streams, int draw, int trials, const double* mean,
                  double* count);

}  // namespace tofsmith
