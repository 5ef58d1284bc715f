// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns why there is nothing to factorize: the camera does not support codes for one of the
/// targets, or its samples cannot represent a Hamiltonian code.
std::optional<BrokenRule> why_not_factorizable(const Camera& camera, const DesignOptions& options);

/// Returns the target correlation functions: the custom target, or Hamiltonian codes with the
/// requested numbers of exposures.
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options);

/// Returns the code without optimization: the ideal demodulation of each target with one pulse.
/// Returns nothing if it is unknown or not supported by the camera.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera);

/// Returns a code that approximates the correlation functions `targets`; not ranked yet.
Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith
