// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Returns the standard deviation of a frame's measurements relative to the one that the filter
/// takes from the camera: second differences of neighbours, which slopes leave 0, along the flatter
/// of rows and columns, in the flattest quarter of blocks of 8 x 8 pixels, among the 128 rows in
/// the middle. None if fewer than 16 blocks have enough usable pixels.
/// @throws std::invalid_argument if the measurements differ from the filter's
std::optional<double> measured_noise_ratio(const Filter& filter, const RawView& raw);

}  // namespace tofsmith
