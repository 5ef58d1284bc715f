// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "design/exposure_shares.hpp"
#include "design/frequencies/square_error.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Square-wave codes that a camera and the options of a design allow.
struct FrequencyChoice {
  std::vector<int> frequencies;     ///< multiples of the fundamental, the highest first
  std::vector<double> left_out_hz;  ///< not multiples, or too short pulses
  std::vector<double> duties;
  std::vector<int> exposures;       ///< the smallest first
  int max_frequencies = 1;          ///< in one code
  int min_phases = 2;               ///< per frequency
  int first_phases = 2;             ///< 3 if it measures ambient light
  int max_repetitions = 1;          ///< per fundamental period, limited by the working distance
  std::vector<double> time_shares;  ///< of one exposure; empty: any

  std::vector<int> exposures_of(int frequencies_of_code) const;
  bool covers_working_distance(const SquareCode& code) const {
    return code.repetitions() <= max_repetitions;
  }
};

/// @throws InvalidArgument if there is no code
FrequencyChoice frequency_choice(const Camera& camera, const DesignOptions& options);

/// Distributes exposures of equal length evenly; the highest frequencies get the remaining ones.
SquareCode with_exposures(SquareCode code, const FrequencyChoice& choice, int exposures);

/// Returns the rule of thumb: the two frequencies with the largest sum whose common unambiguous
/// range covers the working distance, with up to four phases each and equal times, or else the
/// highest such single frequency.
std::optional<SquareCode> rule_of_thumb(const FrequencyChoice& choice);

/// A code and its error, estimated or by trials [m].
struct RatedCode {
  SquareCode code;
  double error_m = infinity;
};

/// Best codes, and a summary of all sets of frequencies.
struct FrequencySearch {
  std::vector<RatedCode> best;
  std::int64_t sets = 0;             ///< sets of frequencies, times duties
  std::int64_t ambiguous = 0;        ///< sets that repeat within the working distance
  std::int64_t pruned_by_bound = 0;  ///< sets that are not among the best for any split of time
};

/// Moves time between frequencies while the error decreases; exposures keep min_exposure_share.
/// @param moved  fraction of the time of the first frequency
/// @return true if the error decreased
template <typename ErrorOf>
bool improve_split(RatedCode& its, double moved, const ErrorOf& error_m_of) {
  bool improves = false;
  for (std::size_t from = 0; from < its.code.tones.size(); ++from)
    for (std::size_t to = 0; to < its.code.tones.size(); ++to) {
      if (from == to) continue;
      SquareCode changed = its.code;
      const double share = moved * changed.tones[from].share;
      changed.tones[from].share -= share;
      changed.tones[to].share += share;
      if (changed.tones[from].share < min_exposure_share * changed.tones[from].phases) continue;
      const double error_m = error_m_of(changed);
      if (!(error_m < its.error_m)) continue;
      its = {std::move(changed), error_m};
      improves = true;
    }
  return improves;
}

/// Splits the time for the smallest estimated error: by descent, or over all sums of listed times.
RatedCode with_best_split(const SquareCode& code, const FrequencyChoice& choice,
                          const SquareErrorEstimate& estimate);

/// Searches all sets of frequencies and duties for the smallest estimated errors, each with the
/// fewest exposures: by the estimate, more exposures of one frequency only add read noise. Skipping
/// branches whose lower bound exceeds the largest kept error does not change the result, nor does
/// the number of threads.
FrequencySearch search_frequencies(const Camera& camera, const FrequencyChoice& choice,
                                   std::size_t kept, const Progress& progress);

}  // namespace tofsmith
