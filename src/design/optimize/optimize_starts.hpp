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

/// Returns start `index`: given codes and then families (Hamiltonian, pulsed multi-frequency, Gray)
/// that fit the space; then the lowest frequency with every higher one in turn; then in turn random
/// mixtures of frequencies, the codes with noise, and random smooth gates with a pulse or with
/// random light.
OptimizeStart optimize_start(const DesignProblem& problem, std::span<const CodeSet> also, int index,
                             RandomStream& random);

/// Returns a random pair for one exposure, as parameters (cells, 1) and (cells, columns).
WaveformParameters random_pair(const DesignProblem& problem, RandomStream& random);

SampledCode sampled_on(const WaveformSpace& space, const CodeSet& code);

bool fits_space(const WaveformSpace& space, const CodeSet& code);

}  // namespace tofsmith
