// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/best_codes.hpp"
#include "design/chip_judge.hpp"

namespace tofsmith {

/// Simulated annealing from the best of the codes given, the cost being log rms, with a penalty for
/// a margin that is too small. All codes it keeps are safe; none is proven best.
/// @note the same for any number of threads: every start has random numbers of its own
BestCodes anneal_chip_codes(const ChipJudge& judge, const std::vector<ChipCode>& seeds,
                            const ChipSearchOptions& options, ChipSearchCounts& counts,
                            const Progress& progress);

}  // namespace tofsmith
