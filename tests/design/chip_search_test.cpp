// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/chip_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "chip_setup.hpp"
#include "design/chips/exhaustive_search.hpp"
#include "each_target.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const OperatingPoint high{1.7e7, 0.0}, low_ambient{1.7e7, 8e7}, low_signal{1.1e6, 0.0};

/// Calls `look` for each assignment of chips to taps or to none; every tap is open at times.
void for_every_assignment(int chips, int taps, bool equal_duty,
                          const std::function<void(const std::vector<ChipWord>&)>& look) {
  std::vector<int> owner(static_cast<std::size_t>(chips), 0);
  for (;;) {
    std::vector<ChipWord> words(static_cast<std::size_t>(taps) + 1, 0);
    for (std::size_t k = 0; k < owner.size(); ++k)
      words[static_cast<std::size_t>(owner[k])] |= ChipWord{1} << k;
    words.pop_back();
    const auto is_shut = [](ChipWord word) { return word == 0; };
    const auto is_other = [&](ChipWord word) {
      return std::popcount(word) != std::popcount(words.front());
    };
    if (std::ranges::none_of(words, is_shut) &&
        !(equal_duty && std::ranges::any_of(words, is_other)))
      look(words);
    auto at = owner.begin();
    while (at != owner.end() && *at == taps) *at++ = 0;
    if (at == owner.end()) return;
    ++*at;
  }
}

/// Minimum metric of all safe one-exposure codes, without symmetry, bounds or ordering.
double raw_optimum_m(const Camera& camera, const ChipSearchOptions& options, double* codes) {
  const int chips = chips_of(camera), taps = camera.sensor.taps;
  const OperatingPoint point = camera.operating.points().front();
  const ChipJudge judge(camera, options);
  double best = std::numeric_limits<double>::infinity();
  *codes = 0;
  for_every_assignment(chips, taps, options.equal_duty, [&](const std::vector<ChipWord>& words) {
    for (ChipWord light = 1; light < all_chips(chips); ++light) {
      ++*codes;
      const ChipCode code{chips, taps, {light}, words};
      const double rms_m = judge.rms_m(judge.score(code));
      if (!(rms_m < best * (1 - 1e-12)) || is_ambiguous(code)) continue;
      if (ambiguity_margin_sigma(code, camera, point, options.separation_periods) >=
          options.margin_sigma)
        best = rms_m;
    }
  });
  return best;
}

TEST(TapAssignments, ListsOneRepresentativeOfEveryClass) {
  for (const bool equal_duty : {true, false})
    for (const bool drain : {true, false})
      for (const int taps : {2, 3}) {
        const AssignmentRules rules{
            .chips = 6, .taps = taps, .equal_duty = equal_duty, .drain = drain};
        const auto kind = [&](const std::vector<ChipWord>& words) {
          std::vector<ChipWord> least;
          for (const bool mirror : {false, true})
            for (int shift = 0; shift < 6; ++shift) {
              std::vector<ChipWord> moved;
              for (const ChipWord word : words)
                moved.push_back(delayed_chips(mirror ? reversed_chips(word, 6) : word, shift, 6));
              std::ranges::sort(moved);
              if (least.empty() || moved < least) least = moved;
            }
          return least;
        };
        std::set<std::vector<ChipWord>> kinds;
        double raw = 0;
        for_every_assignment(6, taps, equal_duty, [&](const std::vector<ChipWord>& words) {
          ChipWord taken = 0;
          for (const ChipWord word : words) taken |= word;
          if (!drain && taken != all_chips(6)) return;
          ++raw;
          kinds.insert(kind(words));
        });
        std::set<std::vector<ChipWord>> listed;
        const auto assignments = tap_assignments(rules);
        for (const TapAssignment& a : assignments)
          listed.insert(kind({a.taps.begin(), a.taps.begin() + taps}));
        EXPECT_EQ(listed, kinds);
        EXPECT_EQ(assignments.size(), kinds.size());
        EXPECT_EQ(raw_tap_assignments(rules), raw);
      }
}

TEST(Search, FindsTheOptimumOfAnExhaustiveEnumeration) {
  struct Case {
    int chips, taps;
    bool equal_duty;
    OperatingPoint point;
    ChipMetric metric = ChipMetric::unknown_light;
  };
  for (const Case& c :
       {Case{6, 3, true, high}, Case{7, 3, true, low_signal}, Case{6, 3, false, low_ambient},
        Case{6, 4, true, high}, Case{5, 4, false, low_ambient},
        Case{7, 3, true, high, ChipMetric::known_light},
        Case{6, 4, true, low_signal, ChipMetric::known_light}}) {
    const Camera camera = chip_camera(c.chips, c.taps, c.point);
    ChipSearchOptions options;
    options.equal_duty = c.equal_duty;
    options.margin_sigma = 4.0;
    options.metric = c.metric;
    double codes = 0;
    const double optimum_m = raw_optimum_m(camera, options, &codes);
    const ChipSearchResult result = search_chip_codes(camera, options);
    EXPECT_TRUE(result.proved);
    EXPECT_EQ(result.log.counts.raw, codes);
    ASSERT_EQ(result.finalists.empty(), std::isinf(optimum_m)) << c.chips;
    if (!result.finalists.empty()) {
      EXPECT_NEAR(result.finalists.front().rms_m, optimum_m, 1e-9 * optimum_m)
          << result.finalists.front().code.text();
    }
  }
}

void expect_optimum_of_all_pairs(ChipMetric metric) {
  const Camera camera = chip_camera(4, 2, low_ambient);
  ChipSearchOptions options;
  options.exposures = 2;
  options.metric = metric;
  options.margin_sigma = 4.0;
  options.finalists = 1;
  const ChipJudge judge(camera, options);
  double best = std::numeric_limits<double>::infinity();
  for_every_assignment(4, 2, true, [&](const std::vector<ChipWord>& first) {
    for_every_assignment(4, 2, true, [&](const std::vector<ChipWord>& second) {
      ChipCode code{4, 2, {0, 0}, first};
      code.demodulation.insert(code.demodulation.end(), second.begin(), second.end());
      for (code.modulation[0] = 1; code.modulation[0] < 15; ++code.modulation[0])
        for (code.modulation[1] = 1; code.modulation[1] < 15; ++code.modulation[1]) {
          const double rms_m = judge.rms_m(judge.score(code));
          if (rms_m < best * (1 - 1e-12) && !is_ambiguous(code) &&
              ambiguity_margin_sigma(code, camera, low_ambient) >= options.margin_sigma)
            best = rms_m;
        }
    });
  });
  const ChipSearchResult result = search_chip_codes(camera, options);
  EXPECT_TRUE(result.proved);
  ASSERT_TRUE(std::isfinite(best));
  ASSERT_FALSE(result.finalists.empty());
  EXPECT_NEAR(result.finalists.front().rms_m, best, 1e-9 * best);
}

TEST(Search, FindsTheOptimumOfAnExhaustiveEnumerationOfPairs) {
  expect_optimum_of_all_pairs(ChipMetric::unknown_light);
  expect_optimum_of_all_pairs(ChipMetric::known_light);
}

TEST(Search, ProvesTheResultsForNineChips) {
  struct Case {
    OperatingPoint point;
    double rms_m;
    const char* light;
  };
  for (const Case& c : {Case{high, 7.874e-3, "111000000"}, Case{low_ambient, 32.83e-3, "111100000"},
                        Case{low_signal, 39.00e-3, "111000000"}}) {
    const ChipSearchResult result = search_chip_codes(chip_camera(9, 3, c.point));
    EXPECT_TRUE(result.proved);
    EXPECT_EQ(result.log.counts.raw, 4969440);
    EXPECT_EQ(result.log.counts.after_symmetry, 6114);
    ASSERT_FALSE(result.finalists.empty());
    EXPECT_NEAR(result.finalists.front().rms_m, c.rms_m, 5e-6);
    EXPECT_GE(result.finalists.front().margin_sigma, 8.0);
    // The standard three-phase square wave.
    EXPECT_EQ(
        symmetry_key(result.finalists.front().code),
        symmetry_key({9,
                      3,
                      {chip_word(c.light)},
                      {chip_word("111000000"), chip_word("000111000"), chip_word("000000111")}}));
  }
}

TEST(Search, CountsEveryCodeOnce) {
  for (const int taps : {3, 4}) {
    const ChipSearchCounts c = search_chip_codes(chip_camera(8, taps, low_ambient)).log.counts;
    EXPECT_EQ(c.examined, c.pruned_by_turning + c.pruned_by_bound + c.metric_evaluations);
    EXPECT_EQ(c.metric_evaluations, c.pruned_by_metric + c.ambiguous + c.below_margin + c.kept);
    EXPECT_GE(static_cast<double>(c.examined), c.after_symmetry);
  }
}

TEST(Search, IsIdenticalForAnyThreadsAndInstructionSet) {
  const auto search = [](int taps, int exposures, double max_exhaustive) {
    ChipSearchOptions options;
    options.exposures = exposures;
    options.max_exhaustive = max_exhaustive;
    options.annealing_starts = 2;
    options.annealing_steps = 200;
    return search_chip_codes(chip_camera(6, taps, low_ambient), options);
  };
  const auto expect_same = [](const ChipSearchResult& a, const ChipSearchResult& b) {
    ASSERT_EQ(a.finalists.size(), b.finalists.size());
    for (std::size_t i = 0; i < a.finalists.size(); ++i) {
      EXPECT_EQ(a.finalists[i].code, b.finalists[i].code);
      EXPECT_EQ(a.finalists[i].rms_m, b.finalists[i].rms_m);
    }
    EXPECT_EQ(a.log.counts.kept, b.log.counts.kept);
    EXPECT_EQ(a.log.improvements.size(), b.log.improvements.size());
  };
  for (const auto& [taps, exposures, largest] : {std::tuple{3, 1, 1e9}, std::tuple{4, 1, 1e9},
                                                 std::tuple{2, 2, 1e9}, std::tuple{3, 2, 0.0}}) {
    const ChipSearchResult first = search(taps, exposures, largest);
    EXPECT_EQ(first.proved, largest > 0.0);
    {
      const ThreadLimit one(1);
      expect_same(first, search(taps, exposures, largest));
    }
    const int t = taps, e = exposures;
    const double l = largest;
    if (l > 0.0) for_each_target([&] { expect_same(first, search(t, e, l)); });
  }
}

TEST(Search, MinimizesTheGeometricMeanOverAllPoints) {
  Camera camera = chip_camera(8, 4, high);
  camera.operating.signal_e_per_s = {1.1e6, 1.7e7};
  camera.operating.ambient_e_per_s = {0.0, 8e7};
  const ChipSearchResult result = search_chip_codes(camera);
  ASSERT_FALSE(result.finalists.empty());
  const ChipFinalist& best = result.finalists.front();
  double log_sum = 0.0;
  for (const OperatingPoint& point : camera.operating.points())
    log_sum += std::log(chip_metric_rms_m(best.code, camera, point));
  EXPECT_NEAR(best.rms_m, std::exp(log_sum / 4), 1e-9 * best.rms_m);
  // At the darkest point no code reaches 8 sigma; the margin of the standard code is required
  // instead.
  EXPECT_LT(result.log.margin_sigma[1], 8.0);
  EXPECT_EQ(result.log.margin_sigma[2], 8.0);
}

TEST(Search, AnnealingIsNoWorseThanItsSeeds) {
  const Camera camera = chip_camera(12, 3, low_ambient);
  ChipSearchOptions options;
  options.exposures = 2;
  options.annealing_starts = 2;
  options.annealing_steps = 300;
  const ChipSearchResult result = search_chip_codes(camera, options);
  EXPECT_FALSE(result.proved);
  EXPECT_THAT(result.proof, HasSubstr("Not proven"));
  ASSERT_FALSE(result.finalists.empty());
  double best_seed = std::numeric_limits<double>::infinity();
  for (const ChipCode& seed : multi_phase_codes(12, 3, 2))
    if (ambiguity_margin_sigma(seed, camera, low_ambient) >= 8.0)
      best_seed = std::min(best_seed, chip_metric_rms_m(seed, camera, low_ambient));
  EXPECT_LT(best_seed, 10.90e-3);  // periods of 4 and 3 chips, light on for 2 and 1
  EXPECT_LE(result.finalists.front().rms_m, best_seed * (1 + 1e-12));
}

TEST(Search, ComparesStandardCodes) {
  const Camera camera = chip_camera(9, 3, high);
  const std::vector<StandardCode> codes = standard_chip_codes(camera, 180);
  ASSERT_EQ(codes.size(), 4U);
  EvaluateOptions options;
  options.trials = 400;
  const auto table = compare_chip_codes(codes, camera, options);
  EXPECT_NEAR(table[1].rms_m, 7.874e-3, 2e-6);  // the three-phase square wave
  // Exclusive taps beat overlapping taps in turn; a pair of coprime periods beats both.
  EXPECT_GT(table[0].circular_mde_m.value, 2.0 * table[1].circular_mde_m.value);
  EXPECT_GT(table[1].circular_mde_m.value, 2.5 * table[3].circular_mde_m.value);
}

TEST(Search, FinalistsAreSortedByTheMetric) {
  ChipSearchOptions options;
  options.finalists = 3;
  const ChipSearchResult result = search_chip_codes(chip_camera(9, 3, high), options);
  ASSERT_EQ(result.finalists.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_LE(result.finalists[i - 1].rms_m, result.finalists[i].rms_m);
}

TEST(Search, StopsOnRequest) {
  EXPECT_THROW(search_chip_codes(chip_camera(9, 3, high), {},
                                 [](double fraction, std::string_view) { return fraction < 0.2; }),
               Interrupted);
}

TEST(Search, RejectsUnsupportedCamerasAndOptions) {
  EXPECT_FALSE(why_not_searchable(chip_camera(9, 3, high), 1));
  EXPECT_EQ(why_not_searchable(built_in_camera("paper-30x"), 3)->field, "sensor.shortest_pulse_s");
  EXPECT_THAT([] { search_chip_codes(built_in_camera("paper-30x")); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("must be in [3, 16]")));
  EXPECT_THAT([] { search_chip_codes(built_in_camera("paper-30x"), {.exposures = 3}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("sensor.shortest_pulse_s = none")));
  EXPECT_THAT([] { search_chip_codes(chip_camera(9, 3, high), {.finalists = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("ChipSearchOptions::finalists = 0")));
}

}  // namespace
}  // namespace tofsmith
