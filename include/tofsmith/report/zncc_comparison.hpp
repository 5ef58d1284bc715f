// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith {

/// Whether codes were decoded by zncc too.
bool is_compared_with_zncc(std::span<const EvaluatedCode> codes);

/// What zncc makes of the same trials, and how many times as large the errors by maximum likelihood
/// are, as geometric means and, if asked, at every light level; headings first.
std::vector<std::vector<std::string>> zncc_comparison_rows(std::span<const EvaluatedCode> codes,
                                                           bool every_level);
/// The same for a page.
Section zncc_comparison(std::span<const EvaluatedCode> codes);

}  // namespace tofsmith
