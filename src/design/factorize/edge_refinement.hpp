// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "design/factorize/alternation.hpp"

namespace tofsmith {

/// Rounds the switching times of a binary pair to points of the camera's generators, with the best
/// of several common delays, then moves single switching times while the residual decreases. Light
/// keeps its full energy.
/// @return none without edges, or if the generators are not coarse compared with the bins
std::optional<WaveformPair> settle_on_points(const PairModel& model, const WaveformPair& pair);

/// Fits the harmonics of the target by moving the switching times of a binary pair (least squares),
/// without additional edges. Light keeps its full energy (level = 1 / duty, duty >= 1 / p), and
/// mean d stays near the mean of the target.
/// @return none if a waveform is constant or not binary
std::optional<WaveformPair> refine_edges(const PairModel& model, const WaveformPair& start);

}  // namespace tofsmith
