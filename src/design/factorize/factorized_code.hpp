// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns why factorization is impossible, or nothing.
std::optional<BrokenRule> why_not_factorizable(const Camera& camera, const DesignOptions& options);

/// Returns the custom target, or Hamiltonian targets.
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options);

/// Returns the ideal demodulations of the targets with one pulse each, if the camera supports them.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera);

Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith
