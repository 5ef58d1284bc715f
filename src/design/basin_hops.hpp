// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/code_score.hpp"
#include "tofsmith/core/random.hpp"

namespace tofsmith {

/// A code that descents have found.
struct PoolEntry {
  WaveformParameters parameters;
  CodeScore score;
  std::string start;  ///< where it began
};

/// A jump out of a basin of the error: one of the best of the pool, softened, with one pair of
/// waveforms replaced (by a random one, or by one of another entry) or its gates rotated against
/// its light, and noise on all.
/// @param pool  best first, not empty
/// @return parameters to descend from, and where they began
PoolEntry hop(const DesignProblem& problem, const std::vector<PoolEntry>& pool,
              RandomStream& random);

/// Parameters no further from soft than `limit`, so that a descent can change them again.
WaveformParameters softened(WaveformParameters parameters, double limit);

}  // namespace tofsmith
