// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/filter/filter_plan.hpp"
#include "decode/filter/time_filter_state.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/time_filter.hpp"

namespace tofsmith {

/// What a Filter knows, for what filters likewise on another processor. Lives as long as its
/// filter, which may be moved.
const Filter::Plan& plan_of(const Filter& filter);

/// The same of a TimeFilter, for what adds frames up likewise.
const TimeFilter::State& state_of(const TimeFilter& filter);

/// @throws std::invalid_argument unless this is a frame of the filter, as Filter::apply
void require_filterable(const Filter::Plan& plan, const RawView& raw,
                        const Image<std::uint8_t>& left_out);

/// Where a filtered frame's numbers are.
FilterPlanes& planes_of(FilteredFrame& frame);

}  // namespace tofsmith
