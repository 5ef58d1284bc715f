// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Why there is nothing to factorize: the camera cannot play codes for one of the targets at all,
/// or its samples cannot represent a Hamiltonian code.
std::optional<BrokenRule> why_not_factorizable(const Camera& camera, const DesignOptions& options);

/// Correlation functions to aim at: the user's, or Hamiltonian ones of every number of exposures
/// asked for.
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options);

/// What a designer would play for the targets without optimization: the ideal demodulation with one
/// pulse each. None if that is not known or cannot be played.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera);

/// The code whose correlation functions come close to `targets`; not judged yet.
Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith
