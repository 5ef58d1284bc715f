// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/shared/random.hpp"
#include "design/frequencies/frequency_search.hpp"
#include "random_sensors.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A chip with five frequencies, two taps and at most six exposures.
Camera small_sensor() {
  Camera camera;
  camera.name = "small";
  camera.fundamental_frequency_hz = 10e6;
  camera.samples = 360;
  camera.exposure_s.total_s = 4e-3;
  camera.light.peak_factor = 2.0;
  camera.light.square.emplace().frequencies_hz = {10e6, 20e6, 50e6, 60e6, 90e6};
  camera.sensor.taps = 2;
  camera.sensor.drain = false;
  camera.sensor.readout = Readout::difference;
  camera.sensor.modulation_contrast = 0.8;
  camera.sensor.max_exposures = 6;
  camera.operating.signal_e_per_s = {3e6, 3e7};
  camera.operating.ambient_e_per_s = {1e6};
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

DesignOptions frequency_options() {
  DesignOptions options;
  options.method = DesignMethod::frequencies;
  options.trials = 5000;
  return options;
}

auto rejects(const char* key, const char* reason) {
  return ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(key), HasSubstr(reason)));
}

/// Calls `visit` with every set of 1 to `most` of the choice's frequencies.
template <typename Visit>
void for_every_set(const FrequencyChoice& choice, int most, const Visit& visit) {
  const unsigned sets = 1u << choice.frequencies.size();
  for (unsigned set = 1; set < sets; ++set) {
    SquareCode code{.duty = choice.duties.front(), .tones = {}};
    for (std::size_t i = 0; i < choice.frequencies.size(); ++i)
      if (set >> i & 1u) code.tones.push_back({.frequency = choice.frequencies[i]});
    const auto count = static_cast<int>(code.tones.size());
    if (count <= most && choice.covers_working_distance(code)) visit(code);
  }
}

TEST(SquareCode, HasTheFrequenciesPhasesAndTimesOfItsTones) {
  const Camera camera = small_sensor();
  const SquareCode code{.duty = 0.5,
                        .tones = {{.frequency = 9, .phases = 4, .share = 0.6},
                                  {.frequency = 2, .phases = 2, .share = 0.4}}};
  const CodeSet set = to_code_set(code, camera);
  EXPECT_EQ(set.name(), "square-9x4-2x2");
  EXPECT_EQ(set.exposures(), 6);
  EXPECT_EQ(why_not_playable(set, camera), std::nullopt);
  for (int e = 0; e < 4; ++e) {
    EXPECT_EQ(set.modulation(e).repetitions(), 9);
    EXPECT_NEAR(set.exposure_shares()[static_cast<std::size_t>(e)], 0.15, 1e-12);
  }
  EXPECT_NEAR(exposure_times_s(set, camera)[5], 0.2 * 4e-3, 1e-15);
  EXPECT_EQ(phases_in_steps(2, 12), (std::vector<int>{0, 3}));
  EXPECT_EQ(phases_in_steps(3, 12), (std::vector<int>{0, 4, 8}));
}

TEST(SquareErrorEstimate, LowerBoundHoldsForEverySplitOfTheTime) {
  for (std::uint64_t sensor = 0; sensor < 4; ++sensor) {
    const Camera camera = random_sensor(5, sensor);
    const FrequencyChoice choice = frequency_choice(camera, frequency_options());
    const SquareErrorEstimate estimate(camera, choice.duties.front(), choice.frequencies.front());
    RandomStream random(7, sensor);
    for (int repeat = 0; repeat < 50; ++repeat) {
      SquareCode code{.duty = choice.duties.front(), .tones = {}};
      for (const int frequency : choice.frequencies)
        if (code.tones.size() < 3 && one_in(random, 2))
          code.tones.push_back({.frequency = frequency});
      if (code.tones.empty()) continue;
      double sum = 0.0;
      for (SquareTone& tone : code.tones) sum += tone.share = between(random, 0.01, 1.0);
      for (SquareTone& tone : code.tones) tone.share /= sum;
      EXPECT_GE(estimate.error_m(code), (1.0 - 1e-12) * estimate.lower_bound_m(code));
    }
  }
}

TEST(SquareErrorEstimate, IsNearTheErrorOfTrials) {
  const Camera camera = small_sensor();
  const SquareErrorEstimate estimate(camera, 0.5, 9);
  for (const auto& [first, second] : {std::pair(9, 1), std::pair(6, 5), std::pair(5, 2)}) {
    const SquareCode code{.duty = 0.5,
                          .tones = {{.frequency = first, .phases = 2, .share = 0.6},
                                    {.frequency = second, .phases = 2, .share = 0.4}}};
    const double error_m =
        evaluate(to_code_set(code, camera), camera, {.trials = 20000, .bounds = false})
            .circular.geometric_mean_m.value;
    EXPECT_NEAR(estimate.error_m(code) / error_m, 1.0, 0.3) << code.name();
  }
}

TEST(FrequencySearch, FindsTheBestEstimateOfAllSets) {
  for (std::uint64_t sensor = 0; sensor < 3; ++sensor) {
    Camera camera = random_sensor(3, sensor);
    camera.light.square->duty_range.reset();
    camera.sensor.max_exposures = 6;
    const FrequencyChoice choice = frequency_choice(camera, frequency_options());
    const SquareErrorEstimate estimate(camera, choice.duties.front(), choice.frequencies.front());
    double least_m = INFINITY;
    for_every_set(choice, choice.max_frequencies, [&](const SquareCode& code) {
      const int exposures = choice.exposures_of(static_cast<int>(code.tones.size())).front();
      const SquareCode all = with_exposures(code, choice, exposures);
      least_m = std::min(least_m, with_best_split(all, choice, estimate).error_m);
    });
    const FrequencySearch search = search_frequencies(camera, choice, 1, {});
    ASSERT_EQ(search.best.size(), 1u);
    EXPECT_EQ(search.best.front().error_m, least_m);
    EXPECT_LT(search.ambiguous, search.sets);
  }
}

TEST(FrequencyDesign, IsNotWorseThanAnySetOfFrequenciesByTrials) {
  const Camera camera = small_sensor();
  const DesignOptions options = frequency_options();
  const DesignResult result = design(camera, options);
  const EvaluateOptions fresh{.trials = 20000, .seed = 99, .bounds = false};
  const Estimate mine = evaluate(result.winner().code, camera, fresh).circular.geometric_mean_m;
  const FrequencyChoice choice = frequency_choice(camera, options);
  int sets = 0;
  for_every_set(choice, 3, [&](const SquareCode& code) {
    for (const int exposures : choice.exposures_of(static_cast<int>(code.tones.size()))) {
      const SquareCode even = with_exposures(code, choice, exposures);
      const Estimate its =
          evaluate(to_code_set(even, camera), camera, fresh).circular.geometric_mean_m;
      EXPECT_LE(mine.value, its.value + 4.0 * std::hypot(its.standard_error, mine.standard_error))
          << even.name();
      ++sets;
    }
  });
  EXPECT_GT(sets, 30);
  EXPECT_EQ(result.winner().method, "frequencies");
  EXPECT_TRUE(result.winner().search->proved);
  EXPECT_THAT(result.explanation, ::testing::Contains(HasSubstr("times the error of")));
}

TEST(FrequencyDesign, MakesUpTheTotalFromListedTimes) {
  Camera camera = small_sensor();
  camera.sensor.integration_times_s = {0.25e-3, 0.5e-3, 1e-3, 1.5e-3};
  const DesignResult result = design(camera, frequency_options());
  const std::vector<double> times_s = exposure_times_s(result.winner().code, camera);
  EXPECT_NEAR(std::accumulate(times_s.begin(), times_s.end(), 0.0), 4e-3, 1e-12);
  for (const double time_s : times_s)
    EXPECT_TRUE(std::ranges::any_of(*camera.sensor.integration_times_s, [&](double listed_s) {
      return std::abs(time_s - listed_s) < 1e-9;
    })) << time_s;
}

TEST(FrequencyDesign, CoversTheWorkingDistanceOnly) {
  Camera camera = small_sensor();
  camera.light.square->frequencies_hz = {20e6, 60e6, 100e6};
  EXPECT_THAT([&] { design(camera, frequency_options()); },
              rejects("light.frequencies_hz", "working_distance_m"));
  camera.operating.working_distance_m = {0.3, 5.0};
  const DesignResult result = design(camera, frequency_options());
  EXPECT_LT(result.winner().error.circular.geometric_mean_m.value, 0.1);
}

TEST(FrequencyDesign, NamesTheKeyThatItCannotUse) {
  const auto designs = [](auto change) {
    return [change] {
      Camera camera = small_sensor();
      change(camera);
      design(camera, frequency_options());
    };
  };
  EXPECT_THAT(designs([](Camera& c) { c.light.square.reset(); }),
              rejects("light.frequencies_hz", "must list"));
  EXPECT_THAT(designs([](Camera& c) { c.fundamental_frequency_hz = 7e6; }),
              rejects("light.frequencies_hz", "fundamental_frequency_hz"));
  EXPECT_THAT(designs([](Camera& c) { c.sensor.max_exposures = 1; }),
              rejects("sensor.max_exposures", "must allow 2 exposures"));
  EXPECT_THAT(designs([](Camera& c) {
                c.exposure_s.each_s = {1e-3, 1e-3};
              }),
              rejects("exposure_s", "must be one total"));
  EXPECT_THAT(designs([](Camera& c) {
                c.sensor.integration_times_s = {0.3e-3, 0.9e-3};
              }),
              rejects("sensor.integration_times_s", "must add up to exposure_s = 0.004"));
}

}  // namespace
}  // namespace tofsmith
