// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "decode/filter/filter_plan.hpp"
#include "decode/filter/time_filter_state.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// Returns the constant data of a Filter, for other devices. Valid as long as the filter, even if
/// it is moved.
const Filter::Plan& plan_of(const Filter& filter);

const TimeFilter::State& state_of(const TimeFilter& filter);

/// @throws std::invalid_argument if the frame does not fit the filter, as Filter::apply()
void require_filterable(const Filter::Plan& plan, const RawView& raw,
                        const Image<std::uint8_t>& left_out);

FilterPlanes& planes_of(FilteredFrame& frame);

/// Returns the ratio of a frame's noise to the noise that the filter expects from the camera. It
/// follows from second differences of neighbouring pixels in the flattest quarter of the blocks of
/// 8 x 8 pixels in the 128 middle rows.
/// @return none if fewer than 16 blocks have enough usable pixels
/// @throws std::invalid_argument if the number of measurements differs from the filter's
std::optional<double> measured_noise_ratio(const Filter& filter, const RawView& raw);

}  // namespace tofsmith
