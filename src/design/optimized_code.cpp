// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimized_code.hpp"

#include <fmt/format.h>

#include <limits>

#include "design/designed_code.hpp"
#include "design/judge.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

namespace {

/// The camera, and with DesignOptions::robust what its band may be instead: other perturbations
/// change the code or the taps, not what the gradients go through.
std::vector<Camera> variants_of(const Camera& camera, const DesignOptions& options) {
  std::vector<Camera> variants{camera};
  if (options.robust)
    for (PerturbedCamera& perturbed : perturbations(camera, {.peak = 0.0, .tap_mismatch = 0.0}))
      variants.push_back(std::move(perturbed.camera));
  return variants;
}

SearchRecord record_of(const OptimizedCode& optimized) {
  SearchRecord record{.work_unit = "descents",
                      .error_name = "smallest depth error so far, by the search's own trials",
                      .account = fmt::format("{} gradient steps", optimized.steps)};
  for (const OptimizeIteration& i : optimized.history)
    record.steps.push_back({static_cast<double>(record.steps.size() + 1), i.best_error_m});
  return record;
}

}  // namespace

std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options) {
  if (!options.exposures.empty()) return options.exposures;
  return suggested_exposures(camera, DesignMethod::optimize);
}

std::string optimized_name(int exposures) { return fmt::format("optimized-k{}", exposures); }

Candidate optimized_candidate(const Camera& camera, int exposures, const DesignOptions& options,
                              const std::vector<Candidate>& starts, const Progress& progress) {
  std::vector<CodeSet> also;
  for (const Candidate& c : starts)
    if (c.code.exposures() == exposures) also.push_back(c.code);
  OptimizeOptions search = options.optimize;
  search.seed = search_seed(options);
  const OptimizedCode optimized =
      optimize(variants_of(camera, options), exposures, search, also, progress);
  Candidate candidate{.code = signed_by(optimized.code.renamed(optimized_name(exposures)),
                                        "optimize", camera, options),
                      .method = "optimize",
                      .iterations = static_cast<int>(
                          std::min<std::int64_t>(optimized.steps, std::numeric_limits<int>::max())),
                      .seconds = optimized.seconds,
                      .search = record_of(optimized),
                      .message = optimized.message};
  candidate.per_measurement = reports_of(candidate.code, optimized.start);
  return candidate;
}

}  // namespace tofsmith
