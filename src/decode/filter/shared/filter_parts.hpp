// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/filter/filter_plan.hpp"
#include "decode/filter/time_filter_state.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/time_filter.hpp"

namespace tofsmith {

/// Returns the constant data of a Filter, for other devices. Valid as long as the filter, even if
/// it is moved.
const Filter::Plan& plan_of(const Filter& filter);

const TimeFilter::State& state_of(const TimeFilter& filter);

/// @throws std::invalid_argument if the frame does not fit the filter, as Filter::apply()
void require_filterable(const Filter::Plan& plan, const RawView& raw,
                        const Image<std::uint8_t>& left_out);

FilterPlanes& planes_of(FilteredFrame& frame);

}  // namespace tofsmith
