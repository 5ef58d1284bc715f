// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith {

/// The lines of a table of errors where light comes back twice, headings first: every code at every
/// signal, single returns, second returns and tails.
std::vector<std::vector<std::string>> multipath_rows(
    const std::vector<MultipathErrorReport>& codes);

/// Heat maps over (delta, r) of bias and error, single-path beside two-return, with their bound,
/// one panel per code and signal; and the table.
Section multipath_section(const std::vector<MultipathErrorReport>& codes);

}  // namespace tofsmith
