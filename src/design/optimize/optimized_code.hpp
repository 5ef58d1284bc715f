// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "design/baselines.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith {

/// As optimize(), and continues each stage of the search from its best codes with free exposure
/// shares: waveforms and shares then descend together, from equal shares. The codes of equal
/// exposures are the same as without; the last code of each stage has exposure_shares(), if its
/// error in trials of the search is smaller.
/// @throws InvalidArgument also if the camera lists the times of the exposures
std::vector<Candidate> optimize_with_shares(std::span<const Camera> variants, int exposures,
                                            const OptimizeOptions& options,
                                            std::span<const CodeSet> also,
                                            const Progress& progress);

/// Returns DesignOptions::exposures or, if empty, the three numbers with the best atlas codes, best
/// first; without them or with operating multipath, suggested_exposures().
std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options,
                                       const Contenders& atlas);

std::string optimized_name(int exposures);

/// Returns the smallest error [m] of the optimized codes in `candidates`, evaluated with the trials
/// of the search. Infinity if the user lists numbers of exposures, or if codes are ranked by more
/// than the error that the search minimizes: root mean square errors, robustness, multipath,
/// interference, exposure times, generators, saturation or a converter.
double error_to_beat_m(const Camera& camera, const DesignOptions& options,
                       std::span<const Candidate> candidates);

/// @param rival_m  error_to_beat_m(); searches of other numbers of exposures end early if they are
///                 clearly worse
/// @throws std::invalid_argument as optimize(); Interrupted
std::vector<Candidate> optimized_candidates(const Camera& camera, int exposures,
                                            const DesignOptions& options,
                                            const std::vector<CodeSet>& starts, double rival_m,
                                            const Progress& progress);

}  // namespace tofsmith
