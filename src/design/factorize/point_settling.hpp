// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "design/factorize/pair_model.hpp"

namespace tofsmith {

/// A binary pair whose switching times are points of the camera's generators, so that they play it
/// as it is: rounded where in time that costs least, then each switching time moved by single
/// points as long as the residual falls. The light keeps its full energy.
/// @return none without generators that are coarse beside the bins, or where nothing switches
std::optional<WaveformPair> settle_on_points(const PairModel& model, const WaveformPair& pair);

}  // namespace tofsmith
