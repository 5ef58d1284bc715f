// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// One index of a candidate per measurement.
using PairChoice = std::vector<std::size_t>;

CodeSet assemble(const std::string& name, const std::vector<Factorization>& factorizations,
                 const PairChoice& choice, const Camera& camera);

/// Selects pairs by depth error, not by residual, changing one measurement at a time from several
/// starts. All evaluations use the same random numbers.
/// @param at_best_rotation  true if codes are rotated later: uses the circular error, because few
///   trials cannot predict the remaining wraps; with weighted depths, the error at the best origin
PairChoice choose_by_depth_error(const std::vector<Factorization>& factorizations,
                                 const Camera& camera, const EvaluateOptions& options,
                                 bool at_best_rotation, const Progress& progress);

/// Returns why factorization is impossible, or nothing.
std::optional<BrokenRule> why_not_factorizable(const Camera& camera, const DesignOptions& options);

/// Returns the custom target, or Hamiltonian targets.
std::vector<TargetSet> targets_for(const Camera& camera, const DesignOptions& options);

/// Returns the ideal demodulations of the targets with one pulse each, if the camera supports them.
std::optional<CodeSet> naive_code(const TargetSet& targets, const Camera& camera);

Candidate factorized_candidate(const TargetSet& targets, const Camera& camera,
                               const DesignOptions& options, const Progress& progress);

}  // namespace tofsmith
