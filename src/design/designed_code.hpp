// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/design/candidate.hpp"

namespace tofsmith {

/// The code, which says by what method, for which camera and from which seed it was made.
CodeSet signed_by(CodeSet code, const std::string& method, const Camera& camera,
                  std::uint64_t seed);

/// What there is to say of the measurements of a code that aims at no target.
std::vector<MeasurementReport> reports_of(const CodeSet& code, const std::string& start);

}  // namespace tofsmith
