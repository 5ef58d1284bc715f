// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Selected pair of each measurement, as index into the candidates of its factorization.
using PairChoice = std::vector<std::size_t>;

/// Builds the code from the selected pairs, with the second bucket if the camera has two.
CodeSet assemble(const std::string& name, const std::vector<Factorization>& factorizations,
                 const PairChoice& choice, const Camera& camera);

/// Selects pairs by depth error instead of residual. Starts from the smallest residuals, the naive
/// pairs and random choices, and changes one measurement at a time as long as the error decreases.
/// All evaluations use the same random numbers, so small differences are significant.
/// @param at_best_rotation  true if codes are later rotated to their best origin. Then the circular
///   error is used, because a few trials cannot predict the remaining wrap-around; with weighted
///   depths, the error at the best origin.
PairChoice choose_by_depth_error(const std::vector<Factorization>& factorizations,
                                 const Camera& camera, const EvaluateOptions& options,
                                 bool at_best_rotation, const Progress& progress);

}  // namespace tofsmith
