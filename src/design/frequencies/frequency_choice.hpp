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
  std::vector<double> left_out_hz;  ///< not multiples of the fundamental, or too short pulses
  std::vector<double> duties;
  std::vector<int> exposures;       ///< numbers of exposures, the smallest first
  int max_frequencies = 1;          ///< in one code
  int min_phases = 2;               ///< per frequency
  int first_phases = 2;             ///< of the first frequency: 3 if it measures ambient light
  int max_repetitions = 1;          ///< per fundamental period, limited by the working distance
  std::vector<double> time_shares;  ///< of one exposure; empty: any

  /// Returns the possible numbers of exposures of a code with a number of frequencies, the smallest
  /// first.
  std::vector<int> exposures_of(int frequencies_of_code) const;
  /// Returns true if the unambiguous range of a code covers the working distance.
  bool covers_working_distance(const SquareCode& code) const {
    return code.repetitions() <= max_repetitions;
  }
};

/// Reason why a camera supports no square-wave code.
std::optional<BrokenRule> why_no_frequencies(const Camera& camera, const DesignOptions& options);

/// @throws InvalidArgument with why_no_frequencies(), if there is a reason
FrequencyChoice frequency_choice(const Camera& camera, const DesignOptions& options);

/// Returns the code with a number of exposures of equal length. They are distributed evenly to the
/// frequencies; the highest frequencies get the remaining ones.
SquareCode with_exposures(SquareCode code, const FrequencyChoice& choice, int exposures);

/// Returns the first choice of the usual rule of thumb: the two frequencies with the largest sum
/// whose common unambiguous range covers the working distance, with four phases each or as many as
/// fit, and equal times. Without such a pair, the highest single frequency whose range covers it;
/// none: no frequency does.
std::optional<SquareCode> rule_of_thumb(const FrequencyChoice& choice);

}  // namespace tofsmith
