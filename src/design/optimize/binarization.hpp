// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "design/optimize/design_problem.hpp"
#include "design/optimize/switched_code.hpp"

namespace tofsmith {

/// Assigns every cell to its largest gate class; with equal duties, the half that favours the first
/// bucket most goes to it. Light is on in the brightest cells, whose number approximates the
/// waveform best within the peak. Non-binary arms stay unchanged.
SwitchedCode binarized(const DesignProblem& problem, const SampledCode& code);

}  // namespace tofsmith
