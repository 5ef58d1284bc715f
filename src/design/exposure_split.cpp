// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_split.hpp"

#include <numeric>
#include <utility>

#include "design/baselines.hpp"
#include "design/exposure_shares.hpp"

namespace tofsmith {

namespace {

/// Corrects rounding errors of the sum.
std::vector<double> normalized(std::vector<double> shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
  return shares;
}

}  // namespace

CodeSet with_split_exposures(const CodeSet& code, const Camera& camera,
                             const DesignOptions& options) {
  const auto exposures = static_cast<std::size_t>(code.exposures());
  CodeSet best = code;
  std::vector<double> shares = code.exposure_shares();
  if (shares.empty()) shares.assign(exposures, 1.0 / static_cast<double>(exposures));
  double least_m = tried_error_m(code, camera, options);
  for (const double moved : {0.3, 0.1, 0.03})
    for (std::size_t from = 0; from < exposures; ++from)
      for (std::size_t to = 0; to < exposures; ++to) {
        if (from == to) continue;
        std::vector<double> changed = shares;
        changed[to] += moved * changed[from];
        changed[from] -= moved * changed[from];
        if (changed[from] < min_exposure_share) continue;
        CodeSet split = code.with_exposure_shares(normalized(changed));
        const double error_m = tried_error_m(split, camera, options);
        if (!(error_m < least_m)) continue;
        least_m = error_m;
        shares = std::move(changed);
        best = std::move(split);
      }
  return best;
}

void add_split_exposures(const Camera& camera, const DesignOptions& options, DesignResult& result,
                         const Progress& progress) {
  if (!camera.exposure_s.each_s.empty()) return;
  const std::size_t count = result.candidates.size();
  for (std::size_t i = 0; i < count; ++i) {
    report(progress, static_cast<double>(i) / static_cast<double>(count), "exposure times");
    Candidate copy = result.candidates[i];
    const bool is_designed = copy.method == "optimize" || copy.method == "factorize";
    if (!is_designed || copy.code.exposures() < 2) continue;
    copy.code = with_split_exposures(copy.code, camera, options);
    if (copy.code.exposure_shares().empty()) continue;
    copy.message += "; exposures of different length";
    result.candidates.push_back(std::move(copy));
  }
}

}  // namespace tofsmith
