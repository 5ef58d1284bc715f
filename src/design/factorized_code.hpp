// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Correlation functions to aim at: the user's, or Hamiltonian ones of every number of exposures
/// asked for.
/// @throws std::invalid_argument if codes for one of them cannot be played at all
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options);

/// What a designer would play for the targets without optimization: the ideal demodulation with one
/// pulse each. None if that is not known or cannot be played.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera);

/// The code whose correlation functions come close to `targets`; not judged yet.
Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith
