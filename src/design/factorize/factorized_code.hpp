// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns why factorization is impossible, or nothing: a target that the camera does not support,
/// or samples that cannot represent a Hamiltonian code.
std::optional<BrokenRule> why_not_factorizable(const Camera& camera, const DesignOptions& options);

/// Returns the custom target, or Hamiltonian ones with the requested numbers of exposures.
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options);

/// Returns the ideal demodulations of the targets with one pulse each, if known and supported by
/// the camera.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera);

/// Returns a code that approximates `targets`, not ranked yet.
Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith
