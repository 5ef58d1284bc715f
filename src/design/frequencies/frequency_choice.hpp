// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "design/frequencies/square_code.hpp"
#include "tofsmith/core/error.hpp"
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

std::optional<BrokenRule> why_no_frequencies(const Camera& camera, const DesignOptions& options);

/// @throws InvalidArgument with why_no_frequencies(), if there is a reason
FrequencyChoice frequency_choice(const Camera& camera, const DesignOptions& options);

/// Distributes exposures of equal length evenly; the highest frequencies get the remaining ones.
SquareCode with_exposures(SquareCode code, const FrequencyChoice& choice, int exposures);

/// Returns the rule of thumb: the two frequencies with the largest sum whose common unambiguous
/// range covers the working distance, with up to four phases each and equal times, or else the
/// highest such single frequency.
std::optional<SquareCode> rule_of_thumb(const FrequencyChoice& choice);

}  // namespace tofsmith
