// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "reproduce/object_scan.hpp"
#include "reproduce/prototype_bench.hpp"

namespace tofsmith {

/// Errors of one object behind one filter, by code: redesigned K = 4, K = 5, sinusoid and
/// multi-frequency.
struct ObjectComparison {
  std::string object;
  double optical_density = 0.0;
  std::vector<ObjectError> errors;

  double better_baseline_m() const { return std::min(errors[2].mean_m, errors[3].mean_m); }
};

/// What the paper says of its scans, beside ours.
std::vector<CheckedStatement> fig10_findings(const std::vector<ObjectComparison>& all,
                                             const PrototypeBench& bench);

}  // namespace tofsmith
