// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/design/design.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// The candidates' errors without and behind second returns, decoded as single-path and as two
/// returns, in the order of what they were chosen by.
Section second_return_section(const SecondReturns& returns, const DesignResult& result,
                              DepthErrorKind kind);

}  // namespace tofsmith
