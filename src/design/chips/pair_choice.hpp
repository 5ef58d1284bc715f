// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// One pair per measurement, as indices into the candidates of each factorization.
using PairChoice = std::vector<std::size_t>;

/// The code made of the chosen pairs, with the second bucket where the camera has two.
CodeSet assemble(const std::string& name, const std::vector<Factorization>& factorizations,
                 const PairChoice& choice, const Camera& camera);

/// Chooses pairs by depth error, not by residual: starts from the smallest residuals, from the
/// naive pairs and from some at random, and changes one measurement at a time as long as the error
/// falls. All trials share their random numbers, so small differences count.
/// @param at_best_rotation  each code gets its best origin later: its circular error is judged, as
///                          few trials tell nothing of how many wraps are left there; where depths
///                          are weighed, its error at that origin
PairChoice choose_by_depth_error(const std::vector<Factorization>& factorizations,
                                 const Camera& camera, const EvaluateOptions& options,
                                 bool at_best_rotation, const Progress& progress);

}  // namespace tofsmith
