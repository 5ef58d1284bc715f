// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/shared/random.hpp"
#include "design/optimize/design_problem.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

struct OptimizeStart {
  std::string name;
  WaveformParameters parameters;
};

/// Returns codes of pulses and square gates of frequency 1 in the first exposures and of one or two
/// higher frequencies in the others. None if all exposures are needed for frequency 1.
std::vector<OptimizeStart> frequency_mixtures(const DesignProblem& problem);

/// Returns the codes in `also` that fit the space, and code families.
std::vector<CodeSet> fitting_codes(const WaveformSpace& space, std::span<const CodeSet> also);

/// Returns start `index` of an endless list:
///   - `codes`, which fit the space, then `mixtures`,
///   - in turn: random mixtures of frequencies, `codes` with noise, and random smooth gates, with
///     one pulse or with random light.
OptimizeStart optimize_start(const DesignProblem& problem, std::span<const CodeSet> codes,
                             std::span<const OptimizeStart> mixtures, int index,
                             RandomStream& random);

/// Random pair of parameters (cells, 1) and (cells, columns).
WaveformParameters random_pair(const DesignProblem& problem, RandomStream& random);

SampledCode sampled_on(const WaveformSpace& space, const CodeSet& code);

}  // namespace tofsmith
