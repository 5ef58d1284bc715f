// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "design/factorize/binary_projection.hpp"
#include "tofsmith/design/circulant_tv.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

struct AlternationResult {
  SampledPair relaxed;   ///< last iterate of the convex steps
  SampledPair playable;  ///< best projection met on the way
  double playable_residual_rms = 0.0;
  std::vector<FactorizeIteration> history;
};

/// Alternates the two convex steps of problem (6) / (7) from `start`: the demodulation that fits
/// best with the modulation fixed, then the modulation with the demodulation fixed.
///
/// The residual's norm is not squared; rms <= rms^2 / (2 c) + c / 2 with c the current rms turns
/// each step into 1/2 |A x - b|^2 + lambda N c TV(x), which does not raise the true objective.
/// @param total_variation_weight  lambda >= 0; 0 leaves total variation out and shows what it is
///        for: each step then goes on from the last waveforms, of which much stays undetermined
AlternationResult alternate(const PairModel& model, SampledPair start,
                            double total_variation_weight, const FactorizeOptions& options,
                            CirculantTvSolver& solver);

}  // namespace tofsmith
