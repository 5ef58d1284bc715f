// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "paper/reproduction.hpp"

#include <algorithm>
#include <utility>

namespace tofsmith {

Verdict overall_verdict(const std::vector<CheckedStatement>& findings) {
  const auto count = [&](Verdict verdict) {
    return std::count_if(findings.begin(), findings.end(),
                         [&](const CheckedStatement& f) { return f.verdict == verdict; });
  };
  if (std::cmp_equal(count(Verdict::holds), findings.size())) return Verdict::holds;
  return std::cmp_equal(count(Verdict::fails), findings.size()) ? Verdict::fails : Verdict::in_part;
}

}  // namespace tofsmith
