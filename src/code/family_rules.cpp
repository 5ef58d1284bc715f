// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/family_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "code/shared/hamiltonian.hpp"

namespace tofsmith {

namespace {

/// Number of harmonics that the forward model keeps.
constexpr int max_frequency = 2048;

}  // namespace

std::optional<BrokenRule> options_misfit(const FamilyOptions& options) {
  if (options.samples < 4) return broken("samples", options.samples, "must be >= 4");
  if (!(options.peak_factor >= 1.0))
    return broken("peak_factor", options.peak_factor, "must be >= 1");
  if (options.taps != 1 && options.taps < 3)
    return broken("taps", options.taps, "must be 1, or >= 3 for exclusive taps");
  return std::nullopt;
}

namespace {

std::optional<BrokenRule> phase_steps_misfit(int steps, int taps) {
  if (steps < 2) return broken("phase steps", steps, "must be >= 2");
  if (steps % taps != 0)
    return broken("phase steps", steps, fmt::format("must be a multiple of the {} taps", taps));
  return std::nullopt;
}

}  // namespace

std::optional<BrokenRule> multi_frequency_misfit(const std::vector<FrequencySteps>& frequencies,
                                                 const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (frequencies.empty()) return broken("number of frequencies", 0, "must be >= 1");
  for (const auto& [frequency, steps] : frequencies) {
    if (frequency < 1 || frequency > max_frequency)
      return broken("frequency", frequency, fmt::format("must be in [1, {}]", max_frequency));
    if (auto misfit = phase_steps_misfit(steps, options.taps)) return misfit;
  }
  return std::nullopt;
}

std::optional<BrokenRule> square_misfit(int phase_steps, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  return phase_steps_misfit(phase_steps, options.taps);
}

std::optional<BrokenRule> pulsed_multi_frequency_misfit(int low_steps, int high_frequency,
                                                        const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (low_steps != 2 && low_steps != 3) return broken("low steps", low_steps, "must be 2 or 3");
  if (high_frequency < 2) return broken("high frequency", high_frequency, "must be >= 2");
  return std::nullopt;
}

std::optional<BrokenRule> gray_misfit(int bits, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (bits < 3 || bits > 10) return broken("bits", bits, "must be in [3, 10]");
  return std::nullopt;
}

std::optional<BrokenRule> walk_misfit(int measurements) {
  if (measurements >= 3 && measurements <= 10) return std::nullopt;
  return broken("measurements of a Hamiltonian code", measurements, "must be in [3, 10]");
}

std::optional<BrokenRule> hamiltonian_misfit(int measurements, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  return walk_misfit(measurements);
}

std::string pulsed_multi_frequency_name(int low_steps, int high_frequency) {
  const std::string name = fmt::format("pulsed-multifrequency-k{}", low_steps + 2);
  return high_frequency == 3 ? name : fmt::format("{}-q{}", name, high_frequency);
}

}  // namespace tofsmith
