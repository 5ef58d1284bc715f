// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/io/result_document.hpp"

namespace tofsmith::apps {

/// Returns a table of depth errors, headings first. Each code has its geometric mean, then the
/// operating points with the least and the largest error, or all of them. Each bound is followed by
/// the ratio of the circular error to it.
std::vector<std::vector<std::string>> evaluation_rows(const std::vector<EvaluatedCode>& codes,
                                                      DepthErrorKind kind, bool every_level);

/// Returns the same as CSV, in metres.
std::string evaluation_csv(const std::vector<EvaluatedCode>& codes);

}  // namespace tofsmith::apps
