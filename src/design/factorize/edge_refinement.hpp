// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

/// Moves the switching times of a binary pair continuously to the least-squares fit of the target's
/// harmonics, number of edges at most as given. The light keeps its full energy (level = 1 / duty,
/// duty >= 1 / p) and mean d is held at the target's.
/// @return none if a waveform never switches, so that there is nothing to move
std::optional<WaveformPair> refine_edges(const PairModel& model, const WaveformPair& start);

}  // namespace tofsmith
