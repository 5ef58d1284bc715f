// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

/// Fits the harmonics of the target by moving the switching times of a binary pair (least squares),
/// without additional edges. Light keeps its full energy (level = 1 / duty, duty >= 1 / p), and
/// mean d stays near the mean of the target.
/// @return none if a waveform is constant or not binary
std::optional<WaveformPair> refine_edges(const PairModel& model, const WaveformPair& start);

}  // namespace tofsmith
