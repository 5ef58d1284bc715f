// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Returns the ratio of a frame's noise to the noise that the filter expects from the camera. It
/// follows from second differences of neighbouring pixels in the flattest quarter of the blocks of
/// 8 x 8 pixels in the 128 middle rows.
/// @return none if fewer than 16 blocks have enough usable pixels
/// @throws std::invalid_argument if the number of measurements differs from the filter's
std::optional<double> measured_noise_ratio(const Filter& filter, const RawView& raw);

}  // namespace tofsmith
