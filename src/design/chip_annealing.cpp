// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/chip_annealing.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>

#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/random.hpp"
#include "tofsmith/core/shared_progress.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr double hottest = 0.15, coldest = 0.005;  // in units of log rms
constexpr double margin_penalty = 2.5;

/// One chain of changes, from one code.
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
    constexpr std::int64_t steps_told = 64;  // at a time
    for (std::int64_t step = 0; step < steps; ++step) {
      if (step % steps_told == 0) progress.add(steps_told);
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
  /// log rms, and how much is missing of the margin; some cost above `limit` if above that.
  double cost(const ChipCode& code, double limit) const {
    const double score = judge_.score(code);
    if (!std::isfinite(score)) return infinity;
    const double log_rms = 0.5 * std::log(score);
    if (log_rms > limit) return log_rms;
    return log_rms + margin_penalty * (1.0 - judge_.sampled_margin_share(code));
  }

  void keep(double share, ChipSearchCounts& counts) {
    const double score = std::exp(2.0 * cost_);  // of a code without penalty
    if (!(score < best_.limit()) || !asked_.insert(code_.text()).second) return;
    if (!judge_.is_safe(code_, counts)) return;
    ++counts.kept;
    best_.offer(code_, judge_.score(code_), share);
  }

  int below(int count) { return static_cast<int>(random_.uniform() * count); }
  ChipWord chip() { return ChipWord{1} << below(judge_.chips()); }

  /// One small change of one exposure.
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

  /// Gives every tap a chip more, or one less.
  void change_duties(ChipWord* taps) {
    const bool grow = below(2) == 0;
    ChipWord taken = 0;
    for (int i = 0; i < judge_.taps(); ++i) taken |= taps[i];
    for (int i = 0; i < judge_.taps(); ++i) {
      const ChipWord from = grow ? all_chips(judge_.chips()) & ~taken : taps[i];
      if (from == 0) return;  // not allowed: is_allowed says so
      ChipWord picked = 0;
      while (picked == 0) picked = chip() & from;
      taps[i] ^= picked;
      taken ^= picked;
    }
  }

  const ChipJudge& judge_;
  RandomStream random_;
  ChipCode code_;
  std::unordered_set<std::string> asked_;  // codes whose safety is settled
  BestCodes best_;
  double cost_;
};

}  // namespace

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
    parallel_for(count, [&](std::int64_t i) {
      const auto at = static_cast<std::size_t>(i);
      chains[at].run(options.annealing_steps, counted[at], shared);
    });
    for (std::size_t i = 0; i < chains.size(); ++i) {
      best.merge(chains[i].best());
      counts += counted[i];
    }
  }
  return best;
}

}  // namespace tofsmith
