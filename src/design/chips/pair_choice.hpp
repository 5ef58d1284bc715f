// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// One pair per measurement, as index of a candidate.
using PairChoice = std::vector<std::size_t>;

/// Adds the second bucket if the camera has two.
CodeSet assemble(const std::string& name, const std::vector<Factorization>& factorizations,
                 const PairChoice& choice, const Camera& camera);

/// Selects pairs by depth error, not by residual. Starts from the smallest residuals, the naive
/// pairs and random choices, and changes one measurement at a time. All evaluations use the same
/// random numbers, so small differences are significant.
/// @param at_best_rotation  true if codes are rotated later. Then the circular error is used,
///   because few trials cannot predict the remaining wraps; with weighted depths, the error at the
///   best origin.
PairChoice choose_by_depth_error(const std::vector<Factorization>& factorizations,
                                 const Camera& camera, const EvaluateOptions& options,
                                 bool at_best_rotation, const Progress& progress);

}  // namespace tofsmith
