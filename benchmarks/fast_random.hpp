// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace tofsmith::benchmarks {

/// Fast random numbers of moderate quality (SplitMix64).
/// @see Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014
class FastRandom {
 public:
  explicit FastRandom(std::uint64_t seed) : state_(seed * 0xd1342543de82ef95u + 1) {}

  std::uint64_t operator()() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Uniform number in [0, 1).
  double uniform() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Number whose logarithm is uniform.
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  /// Uniform integer in [0, count).
  int below(int count) { return static_cast<int>(((*this)() >> 32) * count >> 32); }
  /// Sum of four uniform numbers, with mean 0 and variance 1, within 3.5.
  double normal() {
    const std::uint64_t bits = (*this)();
    const auto sum = static_cast<double>((bits & 0xffff) + (bits >> 16 & 0xffff) +
                                         (bits >> 32 & 0xffff) + (bits >> 48));
    return (sum - 2 * 65535.0) * (1.7320508075688772 / 65536.0);
  }

 private:
  std::uint64_t state_;
};

}  // namespace tofsmith::benchmarks
