// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/random.hpp"

#include <Random123/philox.h>

#include <array>
#include <cmath>
#include <numbers>

namespace tofsmith {

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t work_item, std::uint32_t trial,
                           std::uint32_t block)
    : seed_(seed),
      counter_{block, trial, static_cast<std::uint32_t>(work_item),
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

namespace {

/// Uniform in (0, 1).
double open_uniform(std::uint32_t word) { return (word + 0.5) * 0x1p-32; }

/// ln n! for n < 16.
double log_factorial(double n) {
  static const std::array<double, 16> table = [] {
    std::array<double, 16> values{};
    for (std::size_t i = 2; i < values.size(); ++i)
      values[i] = values[i - 1] + std::log(static_cast<double>(i));
    return values;
  }();
  return table[static_cast<std::size_t>(n)];
}

/// ln of the probability of k; for k >= 16 by Stirling's series, exact in double precision.
double log_probability(double k, double mean) {
  if (k < 16.0) return k * std::log(mean) - mean - log_factorial(k);
  const double r = 1.0 / k, r2 = r * r;
  const double series = r * (1.0 / 12 - r2 * (1.0 / 360 - r2 * (1.0 / 1260 - r2 / 1680)));
  return k * std::log(mean * r) - mean + k - 0.5 * std::log(k) - 0.91893853320467274178 - series;
}

}  // namespace

std::optional<double> attempted_poisson(double mean, std::uint32_t u_word, std::uint32_t v_word) {
  const double u = open_uniform(u_word) - 0.5, v = open_uniform(v_word);
  const double us = 0.5 - std::abs(u);
  const double b = 0.931 + 2.53 * std::sqrt(mean), a = -0.059 + 0.02483 * b;
  const double k = std::floor((2.0 * a / us + b) * u + mean + 0.43);
  if (us >= 0.07 && v <= 0.9277 - 3.6224 / (b - 2.0)) return k;
  if (k < 0.0 || (us < 0.013 && v > us)) return std::nullopt;
  const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
  if (std::log(v * inverse_alpha / (a / (us * us) + b)) > log_probability(k, mean))
    return std::nullopt;
  return k;
}

double inverted_poisson(double mean, std::uint32_t high_word, std::uint32_t low_word) {
  const double u =
      static_cast<double>(((std::uint64_t{high_word} << 32) | low_word) >> 11) * 0x1p-53;
  double probability = std::exp(-mean), rest = u - probability, k = 0.0;
  while (rest >= 0.0 && k < 200.0) {
    probability *= mean / ++k;
    rest -= probability;
  }
  return k;
}

}  // namespace tofsmith
