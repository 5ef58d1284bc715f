// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

/// Fits the harmonics of the target by moving the switching times of a binary pair continuously
/// (least squares). The number of edges does not increase. The light keeps its full energy
/// (level = 1 / duty, duty >= 1 / p), and mean d is kept near that of the target.
/// @return none if a waveform is not binary or is constant
std::optional<WaveformPair> refine_edges(const PairModel& model, const WaveformPair& start);

}  // namespace tofsmith
