// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/design/candidate.hpp"

namespace tofsmith {

CodeSet signed_by(CodeSet code, const std::string& method, const Camera& camera,
                  std::uint64_t seed);

std::vector<MeasurementReport> reports_of(const CodeSet& code, const std::string& start);

}  // namespace tofsmith
