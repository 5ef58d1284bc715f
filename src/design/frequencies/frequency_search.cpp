// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/frequencies/frequency_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/shared/text_numbers.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

constexpr int default_max_exposures = 8;
constexpr int most_frequencies = 4;
constexpr int duties_of_range = 9;

std::vector<double> duties_of(const SquareLight& square) {
  if (!square.duties.empty()) return square.duties;
  if (!square.duty_range) return {square.duty};
  const auto [low, high] = *square.duty_range;
  std::vector<double> duties;
  for (int i = 0; i < duties_of_range; ++i)
    duties.push_back(low + (high - low) * i / (duties_of_range - 1));
  return duties;
}

/// Returns 0 if the frequency is no multiple.
int multiple_of(double frequency_hz, double fundamental_hz) {
  constexpr double tolerance = 1e-6;
  const double ratio = frequency_hz / fundamental_hz;
  const double nearest = std::round(ratio);
  return std::abs(ratio - nearest) <= tolerance * nearest ? static_cast<int>(nearest) : 0;
}

bool keeps_shortest_pulse(double frequency_hz, const std::vector<double>& duties,
                          const Camera& camera) {
  if (!camera.sensor.shortest_pulse_s) return true;
  double shortest = 0.5;
  for (const double duty : duties) shortest = std::min({shortest, duty, 1.0 - duty});
  return shortest / frequency_hz >= *camera.sensor.shortest_pulse_s * (1.0 - 1e-9);
}

std::vector<int> allowed_exposures(const Camera& camera, const DesignOptions& options) {
  std::vector<int> exposures = options.exposures;
  if (camera.playback && !camera.playback->order.empty())
    exposures = {static_cast<int>(camera.playback->order.size())};
  const int most = camera.sensor.max_exposures.value_or(default_max_exposures);
  if (exposures.empty())
    for (int e = 1; e <= most; ++e) exposures.push_back(e);
  std::erase_if(exposures, [&](int e) { return e > most; });
  std::sort(exposures.begin(), exposures.end());
  return exposures;
}

int repetitions_within_distance(const Camera& camera) {
  if (!camera.operating.working_distance_m) return 1;
  const double farthest_m = (*camera.operating.working_distance_m)[1];
  return std::max(1, static_cast<int>(std::floor(camera.range_m() / farthest_m * (1.0 + 1e-9))));
}

std::optional<BrokenRule> why_wrong_camera(const Camera& camera) {
  if (!camera.light.square)
    return broken("light.frequencies_hz", "none",
                  "must list the modulation frequencies that the chip can generate; or give "
                  "light.clock_hz and light.dividers");
  if (camera.sensor.readout == Readout::rows)
    return broken("sensor.readout", "rows",
                  "must be \"separate\" or \"difference\" for square waves");
  if (camera.sensor.taps > 2)
    return broken("sensor.taps", camera.sensor.taps, "must be 1 or 2 for square waves");
  if (!camera.exposure_s.each_s.empty())
    return broken("exposure_s", list_text(camera.exposure_s.each_s),
                  "must be one total, which the design splits between the exposures");
  return std::nullopt;
}

FrequencyChoice choice_for(const Camera& camera, const DesignOptions& options) {
  const SquareLight& square = *camera.light.square;
  FrequencyChoice choice;
  choice.duties = duties_of(square);
  const std::vector<double> all_hz = square.modulation_frequencies_hz();
  for (const double frequency_hz : all_hz) {
    const int multiple = multiple_of(frequency_hz, camera.fundamental_frequency_hz);
    if (multiple > 0 && keeps_shortest_pulse(frequency_hz, choice.duties, camera))
      choice.frequencies.push_back(multiple);
    else
      choice.left_out_hz.push_back(frequency_hz);
  }
  std::sort(choice.frequencies.begin(), choice.frequencies.end(), std::greater<>());
  choice.exposures = allowed_exposures(camera, options);
  choice.first_phases = camera.sensor.mixes_taps() ? 2 : 3;
  choice.max_repetitions = repetitions_within_distance(camera);
  if (camera.sensor.integration_times_s)
    for (const double time_s : *camera.sensor.integration_times_s)
      choice.time_shares.push_back(time_s / camera.exposure_s.total_s);
  while (choice.max_frequencies < most_frequencies &&
         !choice.exposures_of(choice.max_frequencies + 1).empty())
    ++choice.max_frequencies;
  return choice;
}

}  // namespace

std::vector<int> FrequencyChoice::exposures_of(int frequencies_of_code) const {
  const int needed = first_phases + (frequencies_of_code - 1) * min_phases;
  return {std::lower_bound(exposures.begin(), exposures.end(), needed), exposures.end()};
}

FrequencyChoice frequency_choice(const Camera& camera, const DesignOptions& options) {
  require(why_wrong_camera(camera));
  FrequencyChoice choice = choice_for(camera, options);
  require(!choice.frequencies.empty(), "light.frequencies_hz", list_text(choice.left_out_hz),
          fmt::format("must contain multiples of fundamental_frequency_hz = {:.9g}{}",
                      camera.fundamental_frequency_hz,
                      camera.sensor.shortest_pulse_s
                          ? " with pulses of at least sensor.shortest_pulse_s"
                          : ""));
  require(
      !choice.exposures_of(1).empty(), "sensor.max_exposures",
      camera.sensor.max_exposures.value_or(default_max_exposures),
      fmt::format("must allow {0} exposures, and --exposures, if given, must list a number >= {0}",
                  choice.first_phases));
  return choice;
}

SquareCode with_exposures(SquareCode code, const FrequencyChoice& choice, int exposures) {
  for (SquareTone& tone : code.tones) tone.phases = choice.min_phases;
  code.tones.front().phases = choice.first_phases;
  for (std::size_t i = 0; code.exposures() < exposures; i = (i + 1) % code.tones.size())
    ++code.tones[i].phases;
  for (SquareTone& tone : code.tones)
    tone.share = static_cast<double>(tone.phases) / code.exposures();
  return code;
}

std::optional<SquareCode> rule_of_thumb(const FrequencyChoice& choice) {
  std::optional<SquareCode> best;
  const auto sum_of = [](const SquareCode& code) {
    int sum = 0;
    for (const SquareTone& tone : code.tones) sum += tone.frequency;
    return sum;
  };
  const auto consider = [&](const SquareCode& code) {
    if (choice.covers_working_distance(code) && (!best || sum_of(code) > sum_of(*best)))
      best = code;
  };
  const double duty =
      *std::min_element(choice.duties.begin(), choice.duties.end(),
                        [](double a, double b) { return std::abs(a - 0.5) < std::abs(b - 0.5); });
  const std::vector<int>& all = choice.frequencies;
  if (choice.max_frequencies >= 2)
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j)
        consider({.duty = duty, .tones = {{.frequency = all[i]}, {.frequency = all[j]}}});
  for (std::size_t i = 0; i < all.size() && !best; ++i)
    consider({.duty = duty, .tones = {{.frequency = all[i]}}});
  if (!best) return std::nullopt;
  const std::vector<int> possible = choice.exposures_of(static_cast<int>(best->tones.size()));
  const auto usual =
      std::upper_bound(possible.begin(), possible.end(), 4 * static_cast<int>(best->tones.size()));
  return with_exposures(*best, choice, usual == possible.begin() ? possible.front() : usual[-1]);
}

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
  parallel_for_indices(sets.size(),
                       [&](std::size_t at) { bounds_m[at] = estimate.lower_bound_m(sets[at]); });
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
    parallel_for_indices(count, [&](std::size_t at) {
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
