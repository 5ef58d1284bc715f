// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

// First rule that a family member violates. If the grid does not divide the samples, the rule
// suggests the nearest usable N, unless options.exact_grid is false.

std::optional<BrokenRule> options_misfit(const FamilyOptions& options);
std::optional<BrokenRule> multi_frequency_misfit(const std::vector<FrequencySteps>& frequencies,
                                                 const FamilyOptions& options);
std::optional<BrokenRule> square_misfit(int phase_steps, const FamilyOptions& options);
std::optional<BrokenRule> pulsed_multi_frequency_misfit(int low_steps, int high_frequency,
                                                        const FamilyOptions& options);
std::optional<BrokenRule> gray_misfit(int bits, const FamilyOptions& options);
std::optional<BrokenRule> hamiltonian_misfit(int measurements, const FamilyOptions& options);

/// Order of exposures and taps: tap t of exposure e measures step e + t steps / taps.
std::vector<int> steps_by_tap(int steps, int taps);

/// Rule that the walk of a Hamiltonian code violates.
std::optional<BrokenRule> walk_misfit(int measurements);

std::string pulsed_multi_frequency_name(int low_steps, int high_frequency);

/// Names of all members that can be built: up to 10 measurements, higher frequencies up to
/// `highest_frequency`; lists of frequencies are the fundamental and one more with 2 to 4 steps
/// each.
std::vector<std::string> family_members(const FamilyOptions& options, int highest_frequency);

}  // namespace tofsmith
