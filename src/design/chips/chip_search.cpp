// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/chip_search.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_set>

#include "camera/shared/listed_exposures.hpp"
#include "core/shared/random.hpp"
#include "core/shared/shared_progress.hpp"
#include "design/chips/chip_candidates.hpp"
#include "design/chips/chip_judge.hpp"
#include "design/chips/chip_margin.hpp"
#include "design/chips/exhaustive_search.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

constexpr double hottest = 0.15, coldest = 0.005;  // temperatures [log RMS]
constexpr double margin_penalty = 2.5;

class Annealing {
 public:
  Annealing(const ChipJudge& judge, const ChipCode& start, std::uint64_t seed, std::uint64_t chain,
            int finalists)
      : judge_(judge),
        random_(seed, chain),
        code_(start),
        best_(finalists),
        cost_(cost(start, infinity)) {}

  void run(std::int64_t steps, ChipSearchCounts& counts, SharedProgress& progress) {
    constexpr std::int64_t steps_reported = 64;
    for (std::int64_t step = 0; step < steps; ++step) {
      if (step % steps_reported == 0) progress.add(steps_reported);
      const double share = static_cast<double>(step) / static_cast<double>(steps);
      const double temperature = hottest * std::pow(coldest / hottest, share);
      ChipCode changed = code_;
      change(changed);
      ++counts.examined;
      if (!judge_.is_allowed(changed)) continue;
      const double limit = cost_ - temperature * std::log(1.0 - random_.uniform());
      const double changed_cost = cost(changed, limit);
      ++counts.metric_evaluations;
      if (!(changed_cost <= limit)) {
        ++counts.pruned_by_metric;
        continue;
      }
      code_ = std::move(changed);
      cost_ = changed_cost;
      keep(share, counts);
    }
  }
  const BestCodes& best() const { return best_; }

 private:
  double cost(const ChipCode& code, double limit) const {
    const double score = judge_.score(code);
    if (!std::isfinite(score)) return infinity;
    const double log_rms = 0.5 * std::log(score);
    if (log_rms > limit) return log_rms;
    return log_rms + margin_penalty * (1.0 - judge_.sampled_margin_share(code));
  }

  void keep(double share, ChipSearchCounts& counts) {
    const double score = std::exp(2.0 * cost_);
    if (!(score < best_.limit()) || !asked_.insert(code_.text()).second) return;
    if (!judge_.is_safe(code_, counts)) return;
    ++counts.kept;
    best_.offer(code_, judge_.score(code_), share);
  }

  int below(int count) { return static_cast<int>(random_.uniform() * count); }
  ChipWord chip() { return ChipWord{1} << below(judge_.chips()); }

  void change(ChipCode& code) {
    const int exposure = below(code.exposures());
    ChipWord& light = code.modulation[static_cast<std::size_t>(exposure)];
    ChipWord* const taps = code.demodulation.data() + exposure * judge_.taps();
    switch (below(10)) {
      case 0:
      case 1:
      case 2:
        light ^= chip();
        break;
      case 3:
        light ^= chip() | chip();
        break;
      case 4:
        light = delayed_chips(light, 1 + below(judge_.chips() - 1), judge_.chips());
        break;
      case 5:
        change_duties(taps);
        break;
      default:
        swap_chips(taps, chip(), chip());
    }
  }

  void swap_chips(ChipWord* taps, ChipWord a, ChipWord b) const {
    for (int i = 0; i < judge_.taps(); ++i) {
      const bool has_a = (taps[i] & a) != 0, has_b = (taps[i] & b) != 0;
      if (has_a != has_b) taps[i] ^= a | b;
    }
  }

  void change_duties(ChipWord* taps) {
    const bool grow = below(2) == 0;
    ChipWord taken = 0;
    for (int i = 0; i < judge_.taps(); ++i) taken |= taps[i];
    for (int i = 0; i < judge_.taps(); ++i) {
      const ChipWord from = grow ? all_chips(judge_.chips()) & ~taken : taps[i];
      if (from == 0) return;  // rejected by is_allowed()
      ChipWord picked = 0;
      while (picked == 0) picked = chip() & from;
      taps[i] ^= picked;
      taken ^= picked;
    }
  }

  const ChipJudge& judge_;
  RandomStream random_;
  ChipCode code_;
  std::unordered_set<std::string> asked_;
  BestCodes best_;
  double cost_;
};

/// All results are safe; none is proven optimal. Every start has its own random stream, so the
/// result does not depend on the number of threads.
BestCodes anneal_chip_codes(const ChipJudge& judge, const std::vector<ChipCode>& seeds,
                            const ChipSearchOptions& options, ChipSearchCounts& counts,
                            const Progress& progress) {
  BestCodes best(options.finalists);
  BestCodes starts(std::max(1, options.annealing_starts / 3));
  for (const ChipCode& seed : seeds) {
    const double score = judge.score(seed);
    if (!std::isfinite(score)) continue;
    starts.offer(seed, score, 0.0);
    if (score < best.limit() && judge.is_safe(seed, counts)) best.offer(seed, score, 0.0);
  }
  if (starts.codes().empty()) return best;

  constexpr int chains_at_once = 8;
  SharedProgress shared(
      progress,
      static_cast<double>(options.annealing_starts) * static_cast<double>(options.annealing_steps),
      "codes annealed");
  for (int begin = 0; begin < options.annealing_starts; begin += chains_at_once) {
    const int count = std::min(chains_at_once, options.annealing_starts - begin);
    std::vector<Annealing> chains;
    for (int i = begin; i < begin + count; ++i)
      chains.emplace_back(judge,
                          starts.codes()[static_cast<std::size_t>(i) % starts.codes().size()].code,
                          options.seed, static_cast<std::uint64_t>(i), options.finalists);
    std::vector<ChipSearchCounts> counted(chains.size());
    parallel_for_indices(chains.size(), [&](std::size_t at) {
      chains[at].run(options.annealing_steps, counted[at], shared);
    });
    for (std::size_t i = 0; i < chains.size(); ++i) {
      best.merge(chains[i].best());
      counts += counted[i];
    }
  }
  return best;
}

bool can_be_exhaustive(const AssignmentRules& rules, const ChipSearchOptions& options) {
  const bool is_enumerated = rules.taps >= 2 && rules.taps <= max_assigned_taps &&
                             options.exposures <= 2 && (options.exposures == 2 || rules.taps >= 3);
  const double effort = options.exposures == 1 && rules.taps == 3 && rules.equal_duty ? 1.0 : 20.0;
  return is_enumerated &&
         effort * exhaustive_size(rules, options.exposures) <= options.max_exhaustive;
}

std::string proof_text(const ChipSearchCounts& counts, const AssignmentRules& rules,
                       const ChipSearchOptions& options, bool is_found) {
  return fmt::format(
      "All codes of {} exposure{}, {} taps of {} duty and {} chips were searched: {:.0f} of {:.4g} "
      "are different after symmetry. Among the unambiguous codes with sufficient margin, {} by the "
      "metric.",
      options.exposures, options.exposures == 1 ? "" : "s", rules.taps,
      options.equal_duty ? "equal" : "any", rules.chips, counts.after_symmetry, counts.raw,
      is_found ? "no code is better than the finalists" : "none can be ranked");
}

}  // namespace

std::optional<BrokenRule> why_not_searchable(const Camera& camera, int exposures) {
  if (exposures < 1 || exposures > 4)
    return broken("ChipSearchOptions::exposures", exposures, "must be in [1, 4]");
  if (auto reason = why_not_plain(camera)) return reason;
  const int taps = camera.sensor.taps, values = taps * exposures;
  if (values < 3 || values > max_chip_measurements)
    return broken("exposures x sensor.taps", values,
                  "must be in [3, 16]: there are three unknowns, signal, ambient light and depth");
  if (auto reason = why_no_chip_clock(camera)) return reason;
  if (taps > chips_of(camera))
    return broken("sensor.taps", taps, "must not exceed the chips of the clock");
  if (camera.operating.uniform_albedo)
    return broken("operating.albedo", "uniform",
                  "must be a number to search codes by their metric");
  return other_exposures_listed(camera, exposures);
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

ChipSearchResult search_chip_codes(const Camera& on, const ChipSearchOptions& options,
                                   const Progress& progress) {
  options.validate();
  const Camera camera = judged_camera(on);
  require(why_not_searchable(camera, options.exposures));
  const auto begin = std::chrono::steady_clock::now();
  const AssignmentRules rules{.chips = chips_of(camera),
                              .taps = camera.sensor.taps,
                              .equal_duty = options.equal_duty,
                              .drain = camera.sensor.drain};
  ChipSearchResult result;

  ChipJudge judge(camera, options);
  std::vector<ChipCode> seeds = multi_phase_codes(rules.chips, rules.taps, options.exposures);
  std::erase_if(seeds, [&](const ChipCode& code) { return !judge.is_allowed(code); });
  judge.ask_no_more_than(seeds);
  result.log.margin_sigma = judge.asked_sigma();

  const bool is_exhaustive = can_be_exhaustive(rules, options);
  ChipSearchOptions annealing = options;
  if (is_exhaustive) {
    // Fewer starts for pairs would save nothing, because a limit 7 % higher takes 20 times as long.
    annealing.annealing_starts = options.exposures == 1 ? 0 : 8;
    annealing.annealing_steps = 2000;
  }
  const ProgressParts parts(progress, {is_exhaustive ? 5.0 : 95.0, is_exhaustive ? 95.0 : 0.0});
  ChipSearchCounts annealed;
  BestCodes best = anneal_chip_codes(judge, seeds, annealing, annealed, parts[0]);

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
    result.proof =
        "Not proven: too many codes for an exhaustive search; they were optimized by simulated "
        "annealing.";
  }

  for (const ScoredCode& scored : best.codes())
    result.finalists.push_back({.code = scored.code,
                                .rms_m = judge.rms_m(scored.score),
                                .margin_sigma = judge.proven_margin_sigma(scored.code)});
  for (const ScoredCode& scored : best.improvements())
    result.log.improvements.push_back({scored.code, judge.rms_m(scored.score), scored.share});
  result.log.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  report(progress, 1.0, "codes searched");
  return result;
}

}  // namespace tofsmith
