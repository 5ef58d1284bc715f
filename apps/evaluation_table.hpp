// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/io/result_document.hpp"

namespace tofsmith::apps {

/// Depth error at every operating point, each bound beside how many times as large the circular
/// error is; headings first.
std::vector<std::vector<std::string>> evaluation_rows(const std::vector<EvaluatedCode>& codes);

/// The same as a CSV file, in metres.
std::string evaluation_csv(const std::vector<EvaluatedCode>& codes);

}  // namespace tofsmith::apps
