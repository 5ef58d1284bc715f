// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/shared/shared_progress.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/switched_code.hpp"

namespace tofsmith {

/// Minimizes the depth error with respect to all switching times jointly, as continuous variables,
/// by stochastic gradients. Order and number of the edges are kept. Runs remain at least as long as
/// the shortest run of the problem, and pulses do not exceed the peak. Gates of equal duties are
/// not moved.
/// @param steps, trials_per_step  as in DescentSchedule
/// @param progress  updated at every step
SwitchedCode polish_edges(const DesignProblem& problem, SwitchedCode code, int steps,
                          int trials_per_step, std::uint64_t seed, std::uint64_t work_item,
                          SharedProgress* progress = nullptr);

/// Converts a gradient with respect to the samples to one with respect to the switching times:
/// [arm][exposure][edge], light first.
std::vector<std::vector<std::vector<double>>> pull_back_to_edges(const WaveformSpace& space,
                                                                 const SwitchedCode& code,
                                                                 const SampledCode& gradient);

}  // namespace tofsmith
