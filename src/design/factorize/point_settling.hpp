// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

/// Rounds the switching times of a binary pair to points of the camera's generators, so that these
/// reproduce it exactly. The common delay with the smallest residual is chosen; then each switching
/// time is moved by single points as long as the residual decreases. The light keeps its full
/// energy.
/// @return none without generators that are coarse compared with the bins, or without edges
std::optional<WaveformPair> settle_on_points(const PairModel& model, const WaveformPair& pair);

}  // namespace tofsmith
