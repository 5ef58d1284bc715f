// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/shared/shared_progress.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/switched_code.hpp"

namespace tofsmith {

/// Moves the switching times of a code downhill in depth error, as continuous variables and all
/// together, by stochastic gradients. Order and number of the edges stay; runs stay no shorter than
/// the problem's shortest, and no pulse exceeds the peak. Gates of equal duties stay where they
/// are.
/// @param steps, trials_per_step  as in DescentSchedule
/// @param progress called at every step
SwitchedCode polish_edges(const DesignProblem& problem, SwitchedCode code, int steps,
                          int trials_per_step, std::uint64_t seed, std::uint64_t work_item,
                          SharedProgress* progress = nullptr);

/// Gradient by the switching times, arm by arm and exposure by exposure, of a function whose
/// gradient by the samples is given: [arm][exposure][edge], light first.
std::vector<std::vector<std::vector<double>>> pull_back_to_edges(const WaveformSpace& space,
                                                                 const SwitchedCode& code,
                                                                 const SampledCode& gradient);

}  // namespace tofsmith
