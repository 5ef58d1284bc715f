// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/factorize/binary_projection.hpp"
#include "tofsmith/design/circulant_tv.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

struct AlternationResult {
  SampledPair relaxed;
  SampledPair playable;  ///< best projection of all iterates
  double playable_residual_rms = 0.0;
  std::vector<FactorizeIteration> history;
};

/// Alternates the convex steps of problem (6) / (7) from `start`: optimizes demodulation and
/// modulation in turn.
///
/// With c the current rms, rms <= rms^2 / (2 c) + c / 2 converts each step to 1/2 |A x - b|^2 +
/// lambda N c TV(x), which does not increase the objective.
/// @param total_variation_weight  lambda >= 0; 0 omits total variation: each step then starts from
///   the previous waveforms, because the solution is not unique
AlternationResult alternate(const PairModel& model, SampledPair start,
                            double total_variation_weight, const FactorizeOptions& options,
                            CirculantTvSolver& solver);

}  // namespace tofsmith
