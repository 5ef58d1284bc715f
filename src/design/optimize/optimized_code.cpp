// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/optimized_code.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "design/judge.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith {

namespace {

/// With DesignOptions::robust, includes other bandwidths. Gradients do not model other
/// perturbations.
std::vector<Camera> variants_of(const Camera& camera, const DesignOptions& options) {
  std::vector<Camera> variants{camera};
  if (options.robust)
    for (PerturbedCamera& perturbed : perturbations(camera, {.peak = 0.0, .tap_mismatch = 0.0}))
      variants.push_back(std::move(perturbed.camera));
  return variants;
}

}  // namespace

std::vector<int> optimizable_exposures(const Camera& camera, const DesignOptions& options,
                                       const Contenders& atlas) {
  constexpr std::size_t max_tried = 3;
  if (!options.exposures.empty()) return options.exposures;
  // The atlas does not consider second returns.
  if (atlas.codes.empty() || camera.operating.multipath)
    return suggested_exposures(camera, DesignMethod::optimize);
  std::vector<int> exposures;
  for (const CodeSet& code : atlas.codes)
    if (exposures.size() < max_tried &&
        std::find(exposures.begin(), exposures.end(), code.exposures()) == exposures.end())
      exposures.push_back(code.exposures());
  std::sort(exposures.begin(), exposures.end());
  return exposures;
}

std::string optimized_name(int exposures) { return fmt::format("optimized-k{}", exposures); }

std::vector<Candidate> optimized_candidates(const Camera& camera, int exposures,
                                            const DesignOptions& options,
                                            const std::vector<CodeSet>& starts,
                                            const Progress& progress) {
  std::vector<CodeSet> also;
  for (const CodeSet& code : starts)
    if (code.exposures() == exposures) also.push_back(code);
  OptimizeOptions search = options.optimize;
  search.seed = search_seed(options);
  const std::vector<Camera> variants = variants_of(camera, options);
  std::vector<Candidate> candidates =
      options.split_exposures && camera.exposure_s.each_s.empty()
          ? optimize_with_shares(variants, exposures, search, also, progress)
          : optimize(variants, exposures, search, also, progress);
  for (Candidate& c : candidates) c.code.provenance.seed = options.seed;
  return candidates;
}

}  // namespace tofsmith
