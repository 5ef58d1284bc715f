// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace tofsmith {

/// Philox4x32-10 random numbers with key = seed and counter = (draw, trial, work item): an item has
/// the same numbers in any thread or process and in any order of work.
/// @see Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011 (Random123)
class RandomStream {
 public:
  using result_type = std::uint32_t;  // meets UniformRandomBitGenerator
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return 0xffffffffu; }

  /// @param block  first value of the counter; each has 4 words
  RandomStream(std::uint64_t seed, std::uint64_t work_item, std::uint32_t trial = 0,
               std::uint32_t block = 0);

  /// Next 32 random bits.
  result_type operator()();
  /// Uniform on [0, 1), 53 random bits.
  double uniform();
  /// Standard normal (Box-Muller; keeps the second number of a pair).
  double normal();
  /// Poisson count; 0 if mean <= 0.
  double poisson(double mean);

 private:
  std::uint64_t seed_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
  std::optional<double> spare_normal_;
};

std::uint64_t combine_keys(std::uint64_t a, std::uint64_t b);

// Poisson counts that, unlike std::poisson_distribution, are identical on every CPU and C++
// library.

/// Smaller means use inversion instead of rejection.
inline constexpr double min_rejection_mean = 10.0;

/// Transformed rejection, for min_rejection_mean <= mean <= 1e9. None: rejected, try other words.
/// @see Hoermann, The transformed rejection method for generating Poisson random variables,
///      Insurance: Mathematics and Economics 12 (1993): PTRS
std::optional<double> attempted_poisson(double mean, std::uint32_t u_word, std::uint32_t v_word);

/// Smallest k whose distribution function reaches a uniform number of 53 bits; for small means.
double inverted_poisson(double mean, std::uint32_t high_word, std::uint32_t low_word);

}  // namespace tofsmith
