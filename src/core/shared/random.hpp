// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace tofsmith {

/// Random numbers that depend only on their purpose: Philox4x32-10 with key = seed and counter =
/// (draw, trial, work item). Any thread or process draws the same numbers for an item, in any order
/// of work.
/// @see Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011 (Random123)
class RandomStream {
 public:
  using result_type = std::uint32_t;  // meets UniformRandomBitGenerator
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xffffffffu; }

  RandomStream(std::uint64_t seed, std::uint64_t work_item, std::uint32_t trial = 0);

  /// Next 32 random bits.
  result_type operator()();
  /// Uniform on [0, 1), 53 random bits.
  double uniform();
  /// Standard normal (Box-Muller; the second number of a pair is kept for the next call).
  double normal();
  /// Number of events of a Poisson process with this mean; 0 if mean <= 0.
  double poisson(double mean);

 private:
  std::uint64_t seed_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
  std::optional<double> spare_normal_;
};

/// Combines keys to one 64-bit key, for work items identified by several numbers.
std::uint64_t combine_keys(std::uint64_t a, std::uint64_t b);

}  // namespace tofsmith
