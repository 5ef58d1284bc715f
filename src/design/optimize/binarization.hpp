// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "design/optimize/code_score.hpp"
#include "design/optimize/switched_code.hpp"

namespace tofsmith {

/// Converts rendered waveforms to binary ones. Every cell goes to its largest gate class; for two
/// buckets with equal duties, the half of the cells that most favours the first bucket goes to it.
/// Light is on in the brightest cells. Their number is chosen by the judge near the best
/// approximation of the waveform and is large enough not to exceed the peak. Non-binary arms stay
/// unchanged.
SwitchedCode binarized(const DesignProblem& problem, const SampledCode& code,
                       const CodeJudge& judge);

}  // namespace tofsmith
