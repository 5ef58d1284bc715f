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

/// Start of one descent.
struct OptimizeStart {
  std::string name;
  WaveformParameters parameters;
};

/// Returns start `index` of the pool: first the given codes with matching exposures and taps, then
/// matching families (Hamiltonian, pulsed multi-frequency, Gray), then in turn random mixtures of
/// frequencies, random smooth gates with a pulse, the same with random light, and Hamiltonian and
/// pulsed codes with added noise.
OptimizeStart optimize_start(const DesignProblem& problem, std::span<const CodeSet> also, int index,
                             RandomStream& random);

/// Returns a random pair of waveforms for one exposure, as parameters (cells, 1) and (cells,
/// columns), for hops.
WaveformParameters random_pair(const DesignProblem& problem, RandomStream& random);

/// Returns the waveforms of the code on the grid of the space.
SampledCode sampled_on(const WaveformSpace& space, const CodeSet& code);

/// Returns true if the code has the exposures and taps of the space.
bool fits_space(const WaveformSpace& space, const CodeSet& code);

}  // namespace tofsmith
