// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/random.hpp"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

#include "core/poisson_attempt.hpp"

namespace tofsmith {

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t work_item, std::uint32_t trial)
    : seed_(seed),
      counter_{0u, trial, static_cast<std::uint32_t>(work_item),
               static_cast<std::uint32_t>(work_item >> 32)} {}

RandomStream::result_type RandomStream::operator()() {
  if (used_ == 4) {
    const r123::Philox4x32 generator;
    const r123::Philox4x32::ctr_type counter = {
        {counter_[0], counter_[1], counter_[2], counter_[3]}};
    const r123::Philox4x32::key_type key = {
        {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)}};
    const auto words = generator(counter, key);
    for (std::size_t i = 0; i < 4; ++i) block_[i] = words[i];
    ++counter_[0];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

double RandomStream::uniform() {
  const std::uint64_t high = (*this)();
  const std::uint64_t low = (*this)();
  return static_cast<double>(((high << 32) | low) >> 11) * 0x1p-53;
}

double RandomStream::normal() {
  if (spare_normal_) {
    const double value = *spare_normal_;
    spare_normal_.reset();
    return value;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));  // 1 - u is in (0, 1]
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  return radius * std::cos(angle);
}

double RandomStream::poisson(double mean) {
  if (!(mean > 0.0)) return 0.0;
  // Above 1e9 the normal approximation is accurate to all digits that a double count can hold.
  if (mean > 1e9) return std::round(mean + std::sqrt(mean) * normal());
  for (;;) {
    const result_type first = (*this)(), second = (*this)();
    if (mean < min_rejection_mean) return inverted_poisson(mean, first, second);
    if (const auto count = attempted_poisson(mean, first, second)) return *count;
  }
}

std::uint64_t combine_keys(std::uint64_t a, std::uint64_t b) {
  // Finalizer of SplitMix64 over a weighted sum, which decorrelates keys.
  std::uint64_t z = a * 0x9e3779b97f4a7c15ull + b + 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

}  // namespace tofsmith
