// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "decode/filter/time_filter_state.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

/// What a TimeFilter knows, for what adds frames up likewise on another processor. Lives as long as
/// its filter, which may be moved.
const TimeFilter::State& state_of(const TimeFilter& filter);

}  // namespace tofsmith
