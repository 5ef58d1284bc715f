// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/shared/shared_progress.hpp"
#include "design/optimize/design_problem.hpp"
#include "design/optimize/waveform_parameters.hpp"

namespace tofsmith {

/// Assigns every cell to its largest gate class; with equal duties, the half that favours the first
/// bucket most goes to it. Light is on in the brightest cells, whose number approximates the
/// waveform best within the peak. Non-binary arms stay unchanged.
SwitchedCode binarized(const DesignProblem& problem, const SampledCode& code);

/// Minimizes the depth error over all switching times jointly by stochastic gradients. Number and
/// order of edges, the shortest run and the peak are kept. Gates of equal duties are not moved. If
/// the code has exposure shares, they change with the edges.
SwitchedCode polish_edges(const DesignProblem& problem, SwitchedCode code, int steps,
                          int trials_per_step, std::uint64_t seed, std::uint64_t work_item,
                          SharedProgress* progress = nullptr);

/// Minimizes the depth error over the exposure shares of a code with these waveforms, from its own
/// shares, by stochastic gradients. Returns the mean of the last half of the steps.
Eigen::VectorXd descend_shares(const DesignProblem& problem, SampledCode code, int steps,
                               int trials_per_step, std::uint64_t seed, std::uint64_t work_item);

/// Converts a gradient w.r.t. the samples to one w.r.t. the switching times: [arm][exposure][edge],
/// light first.
std::vector<std::vector<std::vector<double>>> pull_back_to_edges(const WaveformSpace& space,
                                                                 const SwitchedCode& code,
                                                                 const SampledCode& gradient);

}  // namespace tofsmith
