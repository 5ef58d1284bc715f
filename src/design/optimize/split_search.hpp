// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

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

}  // namespace tofsmith
