// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/factorize/binary_projection.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

/// Start of one run of the alternation.
struct AlternationStart {
  std::string name;
  SampledPair pair;
};

/// Returns uniform random waveforms with full power. They depend only on the seed, N and `index`,
/// so all measurements have the same starts.
AlternationStart random_start(const PairModel& model, std::uint64_t seed, int index);

/// Returns pairs with the thresholded target as demodulation, and single pulses and pulse trains of
/// several duties as modulation. They are binary, so they are candidates without projection.
std::vector<PairCandidate> structured_starts(const PairModel& model);

/// Returns the unoptimized pair: the demodulation of the target with one pulse of duty
/// max(1/p, ideal). Empty if the ideal waveforms are unknown or the sensor does not support the
/// demodulation.
std::vector<PairCandidate> naive_start(const PairModel& model);

}  // namespace tofsmith
