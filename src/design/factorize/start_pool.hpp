// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design/factorize/binary_projection.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

/// Where one run of the alternation begins.
struct AlternationStart {
  std::string name;
  SampledPair pair;
};

/// Uniform random waveforms of full power. Start `index` depends on the seed and N alone: every
/// measurement begins from the same waveforms.
AlternationStart random_start(const PairModel& model, std::uint64_t seed, int index);

/// The thresholded target as demodulation, with single pulses and pulse trains of several duties as
/// modulation. Binary, so that they are candidates as they stand.
std::vector<PairCandidate> structured_starts(const PairModel& model);

/// The target's own demodulation with one pulse of duty max(1/p, ideal): what a designer would
/// play without any optimization. Empty if the target's waveforms are not known or the sensor
/// cannot play its demodulation.
std::vector<PairCandidate> naive_start(const PairModel& model);

}  // namespace tofsmith
