// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "design/frequencies/frequency_choice.hpp"
#include "design/frequencies/square_error.hpp"
#include "tofsmith/core/progress.hpp"

namespace tofsmith {

/// A code and its estimated error.
struct EstimatedCode {
  SquareCode code;
  double error_m = 0.0;
};

/// Codes of the smallest estimated errors, and what became of all sets of frequencies.
struct FrequencySearch {
  std::vector<EstimatedCode> best;   ///< the smallest error first
  std::int64_t sets = 0;             ///< sets of frequencies, times duties
  std::int64_t ambiguous = 0;        ///< repeat within the working distance
  std::int64_t pruned_by_bound = 0;  ///< no split of the time makes them one of the best
};

/// Splits the total time between the frequencies of a code for the smallest estimated error: by
/// descent, or over all times of the choice's list that add up.
EstimatedCode with_best_split(const SquareCode& code, const FrequencyChoice& choice,
                              const SquareErrorEstimate& estimate);

/// Searches all sets of frequencies and duties for the smallest estimated errors, each set with the
/// fewest exposures: by the estimate, more exposures of one frequency only add read noise.
/// Branches whose lower bound exceeds the error of the last of the best are cut off; none of the
/// best is lost by that.
/// @param kept  number of the best
/// @note same result for any number of threads
FrequencySearch search_frequencies(const Camera& camera, const FrequencyChoice& choice,
                                   std::size_t kept, const Progress& progress);

}  // namespace tofsmith
