// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/searched_code.hpp"

#include <fmt/format.h>

#include "design/designed_code.hpp"
#include "design/judge.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/people_text.hpp"

namespace tofsmith {

namespace {

SearchRecord record_of(const ChipSearchResult& found) {
  const ChipSearchCounts& c = found.log.counts;
  SearchRecord record{
      .work_unit = "% of the search",
      .error_name = "smallest rms error so far, by the Cramer-Rao bound",
      .proved = found.proved,
      .account = fmt::format(
          "{} Of {:.4g} codes, {:.4g} after symmetry, {} were looked at: {} turn back, {} have too "
          "small a slope, {} are worse by the metric ({} evaluations), {} are ambiguous, {} are "
          "below the margin; {} were the best so far.",
          found.proof, c.raw, c.after_symmetry, c.examined, c.pruned_by_turning, c.pruned_by_bound,
          c.pruned_by_metric, c.metric_evaluations, c.ambiguous, c.below_margin, c.kept)};
  for (const ChipImprovement& i : found.log.improvements)
    record.steps.push_back({100.0 * i.share, i.rms_m});
  return record;
}

}  // namespace

std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options) {
  if (options.method == DesignMethod::best && !camera.sensor.shortest_pulse_s) return {};
  chips_of(camera);
  if (!options.exposures.empty()) return options.exposures;
  std::vector<int> searchable;
  for (const int exposures : suggested_exposures(camera, DesignMethod::search))
    if (exposures * camera.sensor.taps >= 3) searchable.push_back(exposures);
  require(!searchable.empty(), "sensor.taps", camera.sensor.taps,
          "too few to search codes of one or two exposures; name the --exposures");
  return searchable;
}

std::string searched_name(int exposures) { return fmt::format("searched-k{}", exposures); }

Candidate searched_candidate(const Camera& camera, int exposures, const DesignOptions& options,
                             const Progress& progress) {
  ChipSearchOptions search = options.search;
  search.exposures = exposures;
  search.seed = search_seed(options);
  search.trials = std::max<std::int64_t>(search.trials, options.search_trials);
  const ChipSearchResult found = search_chip_codes(camera, search, progress);
  require(!found.finalists.empty(), "exposures", exposures,
          "no code on the camera's chip clock tells all depths apart");
  const ChipFinalist& best = found.finalists.front();
  Candidate candidate{.code = signed_by(to_code_set(best.code, camera, searched_name(exposures)),
                                        "search", camera, options),
                      .method = "search",
                      .seconds = found.log.seconds,
                      .search = record_of(found),
                      .message = fmt::format("{}: {} mm rms, {}", best.code.text(),
                                             plain_number(1e3 * best.rms_m, 4),
                                             found.proved ? "proven optimal" : "not proven")};
  candidate.per_measurement = reports_of(candidate.code, "search");
  return candidate;
}

}  // namespace tofsmith
