// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/frequencies/frequency_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr std::array<double, 4> moved_shares = {0.4, 0.15, 0.05, 0.015};

RatedCode with_free_split(RatedCode its, const SquareErrorEstimate& estimate) {
  const auto error_m_of = [&](const SquareCode& code) { return estimate.error_m(code); };
  for (const double moved : moved_shares)
    while (improve_split(its, moved, error_m_of)) {
    }
  return its;
}

void for_each_listed_split(SquareCode& code, const std::vector<double>& time_shares,
                           std::size_t tone, double left,
                           const std::function<void(const SquareCode&)>& visit) {
  constexpr double tolerance = 1e-6;
  if (tone == code.tones.size()) {
    if (std::abs(left) <= tolerance) visit(code);
    return;
  }
  for (const double share : time_shares) {
    const double all = share * code.tones[tone].phases;
    if (all > left + tolerance) continue;
    code.tones[tone].share = all;
    for_each_listed_split(code, time_shares, tone + 1, left - all, visit);
  }
}

RatedCode with_listed_split(SquareCode code, const std::vector<double>& time_shares,
                            const SquareErrorEstimate& estimate) {
  RatedCode best{code, infinity};
  for_each_listed_split(code, time_shares, 0, 1.0, [&](const SquareCode& split) {
    const double error_m = estimate.error_m(split);
    if (error_m < best.error_m) best = {split, error_m};
  });
  double sum = 0.0;  // 1 up to rounding
  for (const SquareTone& tone : best.code.tones) sum += tone.share;
  for (SquareTone& tone : best.code.tones) tone.share /= sum;
  return best;
}

class Best {
 public:
  explicit Best(std::size_t kept) : kept_(kept) {}

  double limit_m() const { return codes_.size() < kept_ ? infinity : codes_.back().error_m; }
  void add(RatedCode its) {
    if (!(its.error_m < limit_m())) return;
    const auto at = std::upper_bound(
        codes_.begin(), codes_.end(), its.error_m,
        [](double error_m, const RatedCode& other) { return error_m < other.error_m; });
    codes_.insert(at, std::move(its));
    if (codes_.size() > kept_) codes_.pop_back();
  }
  std::vector<RatedCode> take() { return std::move(codes_); }

 private:
  std::size_t kept_;
  std::vector<RatedCode> codes_;
};

/// Sets of frequencies that begin with the same frequency.
class Branch {
 public:
  Branch(const FrequencyChoice& choice, double duty, std::size_t first) : choice_(choice) {
    SquareCode code{.duty = duty, .tones = {}};
    add(code, first);
  }

  std::vector<SquareCode> sets;
  std::int64_t all = 0, ambiguous = 0;

 private:
  void add(SquareCode& code, std::size_t index) {
    code.tones.push_back({.frequency = choice_.frequencies[index]});
    const auto count = static_cast<int>(code.tones.size());
    ++all;
    if (choice_.covers_working_distance(code))
      add_exposures(code);
    else
      ++ambiguous;
    if (count < choice_.max_frequencies)
      for (std::size_t next = index + 1; next < choice_.frequencies.size(); ++next) add(code, next);
    code.tones.pop_back();
  }

  /// Adds the code with the fewest exposures; with listed times, every allowed number, because the
  /// sum of the times depends on it.
  void add_exposures(const SquareCode& code) {
    for (const int exposures : choice_.exposures_of(static_cast<int>(code.tones.size()))) {
      sets.push_back(with_exposures(code, choice_, exposures));
      if (choice_.time_shares.empty()) return;
    }
  }

  const FrequencyChoice& choice_;
};

void search_branch(const std::vector<SquareCode>& sets, const FrequencyChoice& choice,
                   const SquareErrorEstimate& estimate, Best& best, FrequencySearch& search) {
  constexpr std::size_t at_a_time = 64;
  std::vector<double> bounds_m(sets.size());
  parallel_for(std::ssize(sets), [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    bounds_m[at] = estimate.lower_bound_m(sets[at]);
  });
  std::vector<std::size_t> order(sets.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return bounds_m[a] < bounds_m[b]; });
  for (std::size_t begin = 0; begin < order.size(); begin += at_a_time) {
    if (!(bounds_m[order[begin]] < best.limit_m())) {
      search.pruned_by_bound += static_cast<std::int64_t>(order.size() - begin);
      return;
    }
    const std::size_t count = std::min(at_a_time, order.size() - begin);
    std::vector<RatedCode> estimated(count);
    parallel_for(static_cast<std::int64_t>(count), [&](std::int64_t i) {
      const auto at = static_cast<std::size_t>(i);
      estimated[at] = with_best_split(sets[order[begin + at]], choice, estimate);
    });
    for (RatedCode& its : estimated) best.add(std::move(its));
  }
}

}  // namespace

RatedCode with_best_split(const SquareCode& code, const FrequencyChoice& choice,
                          const SquareErrorEstimate& estimate) {
  if (!choice.time_shares.empty()) return with_listed_split(code, choice.time_shares, estimate);
  return with_free_split({code, estimate.error_m(code)}, estimate);
}

FrequencySearch search_frequencies(const Camera& camera, const FrequencyChoice& choice,
                                   std::size_t kept, const Progress& progress) {
  FrequencySearch search;
  Best best(kept);
  const double branches =
      static_cast<double>(choice.duties.size()) * static_cast<double>(choice.frequencies.size());
  double done = 0.0;
  for (const double duty : choice.duties) {
    const SquareErrorEstimate estimate(camera, duty, choice.frequencies.front());
    // With a band limit, the highest frequency may not have the smallest local error.
    std::vector<double> bounds_m;
    for (const int frequency : choice.frequencies)
      bounds_m.push_back(estimate.local_bound_m(
          {.frequency = frequency, .phases = choice.min_phases}, choice.max_repetitions));
    for (std::size_t first = 0; first < choice.frequencies.size(); ++first) {
      report(progress, done++ / branches, "frequencies");
      const Branch branch(choice, duty, first);
      search.sets += branch.all;
      search.ambiguous += branch.ambiguous;
      const double bound_m =
          *std::min_element(bounds_m.begin() + static_cast<std::ptrdiff_t>(first), bounds_m.end());
      if (bound_m < best.limit_m())
        search_branch(branch.sets, choice, estimate, best, search);
      else
        search.pruned_by_bound += std::ssize(branch.sets);
    }
  }
  search.best = best.take();
  return search;
}

}  // namespace tofsmith
