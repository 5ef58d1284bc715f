// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "code/shared/family_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <string>

#include "code/shared/hamiltonian.hpp"

namespace tofsmith {

namespace {

std::optional<BrokenRule> grid_misfit(const std::string& family, int cells,
                                      const FamilyOptions& options) {
  if (!options.exact_grid || options.samples % cells == 0) return std::nullopt;
  const int below = std::max(1, options.samples / cells) * cells, above = below + cells;
  const bool above_is_nearer =
      std::abs(above - options.samples) < std::abs(below - options.samples);
  return broken("samples", options.samples,
                fmt::format("{} needs a multiple of {} so that no switching time is rounded; the "
                            "nearest are {} and {} (`--set samples={}`)",
                            family, cells, below, above, above_is_nearer ? above : below));
}

}  // namespace

std::optional<BrokenRule> options_misfit(const FamilyOptions& options) {
  if (options.samples < 4) return broken("samples", options.samples, "must be >= 4");
  if (!(options.peak_factor >= 1.0))
    return broken("peak_factor", options.peak_factor, "must be >= 1");
  return std::nullopt;
}

std::optional<BrokenRule> multi_frequency_misfit(const std::vector<FrequencySteps>& frequencies,
                                                 const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (frequencies.empty()) return broken("number of frequencies", 0, "must be >= 1");
  for (const auto& [frequency, steps] : frequencies) {
    if (frequency < 1) return broken("frequency", frequency, "must be >= 1");
    if (steps < 2) return broken("phase steps", steps, "must be >= 2");
    if (4 * frequency > options.samples)
      return broken("samples", options.samples,
                    fmt::format("must be >= 4 x the highest frequency, {}", 4 * frequency));
  }
  return std::nullopt;
}

std::optional<BrokenRule> square_misfit(int phase_steps, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (phase_steps < 2) return broken("phase steps", phase_steps, "must be >= 2");
  return grid_misfit(fmt::format("square-k{}", phase_steps), std::lcm(2, phase_steps), options);
}

std::optional<BrokenRule> pulsed_multi_frequency_misfit(int low_steps, int high_frequency,
                                                        const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (low_steps != 2 && low_steps != 3) return broken("low steps", low_steps, "must be 2 or 3");
  if (high_frequency < 2) return broken("high frequency", high_frequency, "must be >= 2");
  return grid_misfit(pulsed_multi_frequency_name(low_steps, high_frequency),
                     std::lcm(low_steps == 2 ? 4 : 6, 4 * high_frequency), options);
}

std::optional<BrokenRule> gray_misfit(int bits, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (bits < 3 || bits > 10) return broken("bits", bits, "must be in [3, 10]");
  return grid_misfit(fmt::format("gray-k{}", bits), 1 << bits, options);
}

std::optional<BrokenRule> walk_misfit(int measurements) {
  if (measurements >= 3 && measurements <= 10) return std::nullopt;
  return broken("measurements of a Hamiltonian code", measurements, "must be in [3, 10]");
}

std::optional<BrokenRule> hamiltonian_misfit(int measurements, const FamilyOptions& options) {
  if (auto misfit = options_misfit(options)) return misfit;
  if (auto misfit = walk_misfit(measurements)) return misfit;
  return grid_misfit(fmt::format("hamiltonian-k{}", measurements), hamiltonian_length(measurements),
                     options);
}

std::string pulsed_multi_frequency_name(int low_steps, int high_frequency) {
  const std::string name = fmt::format("pulsed-multifrequency-k{}", low_steps + 2);
  return high_frequency == 3 ? name : fmt::format("{}-q{}", name, high_frequency);
}

}  // namespace tofsmith
