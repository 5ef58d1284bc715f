// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chips/searched_code.hpp"

#include <fmt/format.h>

#include "design/judge.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

SearchRecord record_of(const ChipSearchResult& found) {
  const ChipSearchCounts& c = found.log.counts;
  SearchRecord record{
      .work_unit = "% of the search",
      .error_name = "smallest rms error found: root of the minimized variance",
      .proved = found.proved,
      .account = fmt::format(
          "{} Of {:.4g} codes, {:.4g} after symmetry, {} were examined (a few symmetric ones "
          "twice). Excluded: {} whose coding curve reverses its turn, {} with too small a slope, "
          "{} with a worse metric ({} evaluations), {} ambiguous, {} below the margin. {} improved "
          "on the best code found before.",
          found.proof, c.raw, c.after_symmetry, c.examined, c.pruned_by_turning, c.pruned_by_bound,
          c.pruned_by_metric, c.metric_evaluations, c.ambiguous, c.below_margin, c.kept)};
  for (const ChipImprovement& i : found.log.improvements)
    record.steps.push_back({100.0 * i.share, i.rms_m});
  return record;
}

std::string proof_of(const ChipSearchResult& found, std::size_t place) {
  if (!found.proved) return "not proven";
  return place == 0 ? "proven optimal" : fmt::format("proven rank {} of all codes", place + 1);
}

}  // namespace

std::optional<BrokenRule> why_nothing_to_search(const Camera& camera,
                                                const DesignOptions& options) {
  if (auto reason = why_no_chip_clock(camera)) return reason;
  if (searchable_exposures(camera, options).empty())
    return broken("sensor.taps", camera.sensor.taps,
                  "has too few taps to search codes of one or two exposures; specify --exposures");
  return std::nullopt;
}

std::vector<int> searchable_exposures(const Camera& camera, const DesignOptions& options) {
  if (!options.exposures.empty()) return options.exposures;
  std::vector<int> searchable;
  for (const int exposures : suggested_exposures(camera, DesignMethod::search))
    if (exposures * camera.sensor.taps >= 3) searchable.push_back(exposures);
  return searchable;
}

std::string searched_name(int exposures) { return fmt::format("searched-k{}", exposures); }

std::vector<Candidate> searched_candidates(const Camera& camera, int exposures,
                                           const DesignOptions& options, const Progress& progress) {
  ChipSearchOptions search = options.search;
  search.exposures = exposures;
  search.seed = search_seed(options);
  const ChipSearchResult found = search_chip_codes(camera, search, progress);
  std::vector<Candidate> candidates;
  for (std::size_t place = 0; place < found.finalists.size(); ++place) {
    const ChipFinalist& its = found.finalists[place];
    candidates.push_back(
        {.code = signed_by(to_code_set(its.code, camera, searched_name(exposures)), "search",
                           camera, options.seed),
         .method = "search",
         .seconds = found.log.seconds,
         .search = record_of(found),
         .message = fmt::format("{}: {} mm rms, {}", its.code.text(),
                                plain_number(1e3 * its.rms_m, 4), proof_of(found, place))});
    if (search.metric == ChipMetric::known_light)
      candidates.back().message += ", for known signal and ambient light";
    candidates.back().per_measurement = reports_of(candidates.back().code, "search");
  }
  return candidates;
}

}  // namespace tofsmith
