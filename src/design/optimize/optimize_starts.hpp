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

/// Where one descent begins.
struct OptimizeStart {
  std::string name;
  WaveformParameters parameters;
};

/// Start `index` of the pool: first the codes given that have the exposures and taps of the space,
/// then the families that have them (Hamiltonian, pulsed multi-frequency, Gray), then in turn
/// random mixtures of frequencies, random smooth gates with a pulse, the same with random light,
/// and Hamiltonian and pulsed codes again with noise on them.
OptimizeStart optimize_start(const DesignProblem& problem, std::span<const CodeSet> also, int index,
                             RandomStream& random);

/// A random pair of waveforms for one exposure, as parameters (cells, 1) and (cells, columns):
/// what a hop may put in place of another.
WaveformParameters random_pair(const DesignProblem& problem, RandomStream& random);

/// The code's waveforms on the grid of the space.
SampledCode sampled_on(const WaveformSpace& space, const CodeSet& code);

/// Whether the code has the exposures and taps of the space.
bool fits_space(const WaveformSpace& space, const CodeSet& code);

}  // namespace tofsmith
