// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "design/optimize/code_score.hpp"
#include "design/optimize/switched_code.hpp"

namespace tofsmith {

/// The playable code next to rendered waveforms. Gates go to the largest class of every cell (of
/// two buckets with equal duties, the cells that favour the first most). Light goes to the
/// brightest cells, as many of them as the judge likes best, near the number that fits the waveform
/// best and never so few that the peak would be exceeded. Arms that need not switch stay as they
/// are.
SwitchedCode binarized(const DesignProblem& problem, const SampledCode& code,
                       const CodeJudge& judge);

}  // namespace tofsmith
