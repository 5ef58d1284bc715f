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

/// Returns start `index` of an endless list:
///   - given codes and families that fit the space,
///   - frequency 1 with each higher useful frequency,
///   - in turn: random mixtures of frequencies, given codes and families with noise, and random
///     smooth gates, with one pulse or with random light.
OptimizeStart optimize_start(const DesignProblem& problem, std::span<const CodeSet> also, int index,
                             RandomStream& random);

/// Random pair of parameters (cells, 1) and (cells, columns).
WaveformParameters random_pair(const DesignProblem& problem, RandomStream& random);

SampledCode sampled_on(const WaveformSpace& space, const CodeSet& code);

bool fits_space(const WaveformSpace& space, const CodeSet& code);

}  // namespace tofsmith
