// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/chip_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "design/chip_annealing.hpp"
#include "design/chip_light.hpp"
#include "design/chip_margin.hpp"
#include "design/exhaustive_search.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/design/standard_chip_codes.hpp"

namespace tofsmith {

namespace {

/// Whether all codes can be tried, and how many about that is.
bool can_be_exhaustive(const AssignmentRules& rules, const ChipSearchOptions& options) {
  const bool is_enumerated = rules.taps >= 2 && rules.taps <= most_assigned_taps &&
                             options.exposures <= 2 && (options.exposures == 2 || rules.taps >= 3);
  const double effort = options.exposures == 1 && rules.taps == 3 && rules.equal_duty ? 1.0 : 20.0;
  return is_enumerated &&
         effort * exhaustive_size(rules, options.exposures) <= options.largest_exhaustive;
}

ChipFinalist finalist_of(const ScoredCode& scored, const ChipJudge& judge) {
  return {.code = scored.code,
          .rms_m = judge.rms_m(scored.score),
          .margin_sigma = judge.proven_margin_sigma(scored.code)};
}

std::string proof_text(const ChipSearchCounts& counts, const AssignmentRules& rules,
                       const ChipSearchOptions& options, bool is_found) {
  return fmt::format(
      "All codes of {} exposure{}, {} taps of {} duty and {} chips were tried: {:.0f} of {:.4g} "
      "are "
      "left after symmetry. {} by the metric among those that are not ambiguous and keep the "
      "margin.",
      options.exposures, options.exposures == 1 ? "" : "s", rules.taps,
      options.equal_duty ? "equal" : "any", rules.chips, counts.after_symmetry, counts.raw,
      is_found ? "No code is better than the finalists" : "None can be ranked");
}

}  // namespace

std::optional<BrokenRule> why_not_searchable(const Camera& camera, int exposures) {
  if (exposures < 1 || exposures > 4)
    return broken("ChipSearchOptions::exposures", exposures, "must be in [1, 4]");
  if (auto reason = why_not_plain(camera)) return reason;
  const int taps = camera.sensor.taps, values = taps * exposures;
  if (values < 3 || values > most_chip_measurements)
    return broken("exposures x sensor.taps", values,
                  "must be in [3, 16]: signal, ambient light and depth are unknown");
  if (auto reason = why_no_chip_clock(camera)) return reason;
  if (taps > chips_of(camera))
    return broken("sensor.taps", taps, "must not exceed the chips of the clock");
  if (camera.operating.uniform_albedo)
    return broken("operating.albedo", "uniform",
                  "must be a number to search codes by their metric");
  const std::size_t listed = camera.exposure_s.each_s.size();
  if (listed != 0 && listed != static_cast<std::size_t>(exposures))
    return broken("number of exposure_s", listed, "must equal the exposures");
  return std::nullopt;
}

void ChipSearchOptions::validate() const { check_fields(*this, "ChipSearchOptions::"); }

ChipSearchCounts& ChipSearchCounts::operator+=(const ChipSearchCounts& other) {
  raw += other.raw;
  after_symmetry += other.after_symmetry;
  examined += other.examined;
  pruned_by_turning += other.pruned_by_turning;
  pruned_by_bound += other.pruned_by_bound;
  metric_evaluations += other.metric_evaluations;
  pruned_by_metric += other.pruned_by_metric;
  ambiguous += other.ambiguous;
  below_margin += other.below_margin;
  kept += other.kept;
  return *this;
}

ChipSearchResult search_chip_codes(const Camera& camera, const ChipSearchOptions& options,
                                   const Progress& progress) {
  options.validate();
  camera.validate();
  require(why_not_searchable(camera, options.exposures));
  const auto begin = std::chrono::steady_clock::now();
  const AssignmentRules rules{.chips = chips_of(camera),
                              .taps = camera.sensor.taps,
                              .equal_duty = options.equal_duty,
                              .drain = camera.sensor.drain};
  ChipSearchResult result;

  // 1. Standard codes say what margin can be asked, and where to start.
  ChipJudge judge(camera, options);
  std::vector<ChipCode> seeds = multi_phase_codes(rules.chips, rules.taps, options.exposures);
  std::erase_if(seeds, [&](const ChipCode& code) { return !judge.is_allowed(code); });
  judge.ask_no_more_than(seeds);
  result.log.margin_sigma = judge.asked_sigma();

  // 2. Annealing finds good codes: the answer, or what an exhaustive search prunes by.
  const bool is_exhaustive = can_be_exhaustive(rules, options);
  ChipSearchOptions annealing = options;
  if (is_exhaustive) {
    // One exposure is searched faster than annealed. Pairs cannot do without: a limit 7 % higher
    // takes 20 times as long, so that fewer starts than these save nothing.
    annealing.annealing_starts = options.exposures == 1 ? 0 : 8;
    annealing.annealing_steps = 2000;
  }
  const ProgressParts parts(progress, {is_exhaustive ? 5.0 : 95.0, is_exhaustive ? 95.0 : 0.0});
  ChipSearchCounts annealed;
  BestCodes best = anneal_chip_codes(judge, seeds, annealing, annealed, parts[0]);

  // 3. Then all codes, if there are not too many.
  if (is_exhaustive) {
    const ExhaustiveTask task{.judge = &judge,
                              .rules = rules,
                              .finalists = options.finalists,
                              .limit = best.codes().empty() ? infinity : best.limit()};
    ExhaustiveFinding finding = options.exposures == 1 ? search_single_exposures(task, parts[1])
                                                       : search_exposure_pairs(task, parts[1]);
    best = std::move(finding.best);
    result.log.counts = finding.counts;
    result.proved = true;
    result.proof = proof_text(finding.counts, rules, options, !best.codes().empty());
  } else {
    result.log.counts = annealed;
    result.proof = "Not proven: there are too many codes to try them all; these were annealed.";
  }

  // 4. The finalists, with proven margins.
  for (const ScoredCode& scored : best.codes())
    result.finalists.push_back(finalist_of(scored, judge));
  for (const ScoredCode& scored : best.improvements())
    result.log.improvements.push_back({scored.code, judge.rms_m(scored.score), scored.share});
  result.log.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report(progress, 1.0, "codes searched");
  return result;
}

}  // namespace tofsmith
