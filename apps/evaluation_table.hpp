// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/io/result_document.hpp"

namespace tofsmith::apps {

/// Geometric mean of the depth error of each code, then the error at the light where it is least
/// and where it is most, or at every one; each bound beside how many times as large the circular
/// error is; headings first.
std::vector<std::vector<std::string>> evaluation_rows(const std::vector<EvaluatedCode>& codes,
                                                      DepthErrorKind kind, bool every_level);

/// The same as a CSV file, in metres.
std::string evaluation_csv(const std::vector<EvaluatedCode>& codes);

}  // namespace tofsmith::apps
