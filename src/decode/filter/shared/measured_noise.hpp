// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Returns the standard deviation of a frame's measurements, divided by the one that the filter
/// expects from the camera. It follows from the second differences of neighbouring pixels, which
/// are 0 on slopes. Of the blocks of 8 x 8 pixels in the 128 middle rows, the flattest quarter
/// counts, each along the flatter of rows and columns.
/// @return none if fewer than 16 blocks have enough usable pixels
/// @throws std::invalid_argument if the number of measurements differs from the filter's
std::optional<double> measured_noise_ratio(const Filter& filter, const RawView& raw);

}  // namespace tofsmith
