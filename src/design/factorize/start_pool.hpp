// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/factorize/binary_projection.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

struct AlternationStart {
  std::string name;
  SampledPair pair;
};

AlternationStart random_start(const PairModel& model, std::uint64_t seed, int index);

/// Returns binary pairs of the thresholded target with single pulses and pulse trains.
std::vector<PairCandidate> structured_starts(const PairModel& model);

/// Returns the target's ideal demodulation with one pulse of duty max(1/p, ideal); empty if unknown
/// or not supported.
std::vector<PairCandidate> naive_start(const PairModel& model);

}  // namespace tofsmith
