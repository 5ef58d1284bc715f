// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "design/atlas/nearest_codes.hpp"
#include "design/run_lengths.hpp"
#include "design_setup.hpp"
#include "german_locale.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

const std::string one_code =
    "tofsmith atlas 1\n"
    "# a comment\n"
    "code taps 1 exposures 3 peak 4 bandwidth 10 shortest 0 error linear linear_m 0.2 0.001 "
    "circular_m 0.1 0.0005\n"
    "light 0 25000\ngate 0 50000\n"
    "light 0 25000\ngate 33333 83333\n"
    "light 90000 115000\ngate 66667 116667\n";

std::string replaced(const std::string& what, const std::string& by) {
  std::string text = one_code;
  text.replace(text.find(what), what.size(), by);
  return text;
}

void expect_refused(const std::string& text, const char* place, const char* problem) {
  EXPECT_THAT([&] { parse_atlas(text, "a.txt"); },
              ThrowsMessage<IoError>(AllOf(StartsWith(place), HasSubstr(problem))))
      << text;
}

TEST(Atlas, ReadsCamerasErrorsAndSwitchingTimes) {
  const std::vector<AtlasEntry> entries = parse_atlas(one_code);
  ASSERT_EQ(entries.size(), 1u);
  const AtlasEntry& entry = entries[0];
  EXPECT_EQ(entry.of, (AtlasCamera{.peak_factor = 4,
                                   .bandwidth_f0 = 10,
                                   .taps = 1,
                                   .exposures = 3,
                                   .error = DepthErrorKind::linear}));
  EXPECT_EQ(entry.code.name(), "atlas-3x1-peak4-hann10-linear");
  EXPECT_EQ(entry.error_m().value, 0.2);
  EXPECT_EQ(entry.circular_m.standard_error, 0.0005);
  EXPECT_EQ(entry.code.demodulation(1).on_intervals(),
            (std::vector<OnInterval>{{0.33333, 0.83333}}));
  EXPECT_EQ(entry.code.modulation(2).on_intervals(), (std::vector<OnInterval>{{0.9, 1.15}}));
  EXPECT_EQ(entry.code.peak(), 4.0);
  EXPECT_TRUE(parse_atlas("tofsmith atlas 1\n").empty());
}

TEST(Atlas, RefusesAnotherVersionAndDamage) {
  expect_refused(replaced("atlas 1", "atlas 2"), "a.txt:1", "version 2; expected version 1");
  expect_refused("", "a.txt:1", "expected \"tofsmith atlas 1\"");
  expect_refused("{}", "a.txt:1", "found \"{}\"");
  expect_refused(replaced("peak 4", "peak 0.5"), "a.txt:3", "found \"0.5\"; expected a number in");
  expect_refused(replaced("peak 4", "peak nan"), "a.txt:3", "found \"nan\"");
  expect_refused(replaced("peak 4", "crest 4"), "a.txt:3", "expected \"peak\"");
  expect_refused(replaced("exposures 3", "exposures 3.5"), "a.txt:3", "a whole number");
  expect_refused(replaced("linear linear_m", "angular linear_m"), "a.txt:3", "circular");
  expect_refused(replaced("bandwidth 10", "bandwidth 0"), "a.txt:3", "expected one of them > 0");
  expect_refused(replaced("0.0005\n", "0.0005 7\n"), "a.txt:3", "the end of the line");
  expect_refused(replaced("light 0 25000", "light 0 250000"), "a.txt:4", "[1, 100000]");
  expect_refused(replaced("light 0 25000", "light"), "a.txt:4", "never on");
  expect_refused(replaced("gate 0 50000", "gate 40000 50000 0 10000"), "a.txt:5", "sorted");
  expect_refused(replaced("gate 0 50000\n", ""), "a.txt:5", "expected \"gate\"");
  expect_refused(one_code.substr(0, one_code.find("gate 66667")), "a.txt:9", "found the end");
  expect_refused(one_code + one_code.substr(one_code.find("code")), "a.txt:", "a second time");
}

TEST(Atlas, EveryCodeFitsItsOwnCamera) {
  ASSERT_FALSE(code_atlas().empty());
  for (const AtlasEntry& entry : code_atlas()) {
    const Camera camera = entry.of.camera();
    EXPECT_EQ(why_not_playable(entry.code, camera), std::nullopt) << entry.code.name();
    EXPECT_TRUE(keeps_shortest_run(entry.code, camera)) << entry.code.name();
    EXPECT_EQ(entry.code.exposures(), entry.of.exposures);
    EXPECT_EQ(find_atlas_entry(entry.code.name()), &entry);
  }
  EXPECT_EQ(find_atlas_entry("atlas-t1-k4-p15-b10-linear"),
            find_atlas_entry("atlas-4x1-peak15-hann10-linear"));
  EXPECT_EQ(find_atlas_entry("atlas"), nullptr);
}

TEST(Atlas, StatedErrorsMatchMonteCarlo) {
  const std::vector<AtlasEntry>& atlas = code_atlas();
  constexpr std::size_t judged = 12;
  for (std::size_t i = 0; i < judged; ++i) {
    const AtlasEntry& entry = atlas[i * (atlas.size() - 1) / (judged - 1)];
    const DepthErrorReport report =
        evaluate(entry.code, entry.of.camera(), {.trials = 4000, .seed = 99, .bounds = false});
    for (const auto& [stated, found] :
         {std::pair{entry.linear_m, report.linear.geometric_mean_m},
          std::pair{entry.circular_m, report.circular.geometric_mean_m}})
      // Codes were selected as the best of several and have rounded switching times: allow 1 % in
      // addition to the noise.
      EXPECT_NEAR(
          found.value, stated.value,
          4.0 * std::hypot(found.standard_error, stated.standard_error) + 0.01 * stated.value)
          << entry.code.name();
  }
}

TEST(Atlas, BandwidthFollowsFromHannResponsesOrTheShortestPulse) {
  Camera camera = built_in_camera("paper-10f0");
  EXPECT_NEAR(effective_bandwidth_f0(camera), 10.0, 0.01);
  camera.sensor.shortest_pulse_s = 0.1444 / camera.fundamental_frequency_hz;
  EXPECT_NEAR(effective_bandwidth_f0(camera), 5.0, 0.01);
  EXPECT_TRUE(std::isinf(effective_bandwidth_f0(built_in_camera("paper-30x"))));
}

TEST(Atlas, FittingToAPeakKeepsPulsePositionsAndMeanLight) {
  const AtlasEntry entry = parse_atlas(one_code)[0];
  for (const double peak : {2.0, 3.0, 8.0}) {
    const CodeSet fitted = fitted_to_peak(entry.code, 4.0, peak);
    EXPECT_NEAR(fitted.peak(), peak, 1e-9);
    for (int e = 0; e < 3; ++e) {
      EXPECT_NEAR(fitted.modulation(e).mean(), 1.0, 1e-9);
      const Eigen::VectorXcd before = entry.code.modulation(e).harmonics(1);
      const Eigen::VectorXcd after = fitted.modulation(e).harmonics(1);
      EXPECT_NEAR(std::arg(after[1] / before[1]), 0.0, 1e-9);
      EXPECT_EQ(fitted.demodulation(e), entry.code.demodulation(e));
    }
  }
  expect_same_code(fitted_to_peak(entry.code, 4.0, 4.0), entry.code);
}

TEST(Atlas, ReturnsTheNearestCodesThatSuitACamera) {
  std::string text = one_code.substr(0, one_code.find("code"));
  const std::string code = one_code.substr(one_code.find("code"));
  for (const char* band : {"3", "5", "10", "20"}) {
    std::string entry = code;
    entry.replace(entry.find("bandwidth 10"), 12, std::string("bandwidth ") + band);
    text += entry;
  }
  const std::vector<AtlasEntry> atlas = parse_atlas(text);
  Camera camera = built_in_camera("paper-10f0");  // 15 times the mean
  const auto names = [&](const std::vector<int>& exposures, int cameras) {
    std::vector<std::string> found;
    for (const CodeSet& its : nearest_atlas_codes(atlas, camera, exposures, cameras)) {
      EXPECT_EQ(why_not_playable(its, camera), std::nullopt);
      EXPECT_EQ(its.samples(), camera.samples);
      found.push_back(fmt::format("{}:{:.3g}", its.name(), its.peak()));
    }
    return found;
  };
  EXPECT_THAT(names({}, 1), testing::ElementsAre("atlas-3x1-peak4-hann10-linear:15",
                                                 "atlas-3x1-peak4-hann10-linear:4"));
  EXPECT_EQ(names({}, 2).size(), 4u);
  EXPECT_TRUE(names({4}, 2).empty());
  EXPECT_TRUE(names({}, 0).empty());
  camera.light.peak_factor = 3;  // the original codes need a peak factor of 4
  EXPECT_THAT(names({}, 1), testing::ElementsAre("atlas-3x1-peak4-hann10-linear:3"));
  camera.sensor.taps = 2;
  EXPECT_TRUE(names({}, 4).empty());
}

/// Interpolates and extrapolates the cameras of the atlas.
std::vector<Camera> other_cameras() {
  std::vector<Camera> cameras;
  for (const DepthErrorKind kind : {DepthErrorKind::linear, DepthErrorKind::circular}) {
    AtlasCamera of{.peak_factor = 11, .bandwidth_f0 = 7, .error = kind};
    cameras.push_back(of.camera());
    of.taps = 2;
    cameras.push_back(of.camera());
    cameras.push_back(coarse_camera("paper-30x", kind));
  }
  for (Camera& camera : cameras) camera.operating.signal_e_per_s = {1e4, 1e5};
  return cameras;
}

TEST(Atlas, ADesignIsNeverWorseThanTheNearestCodes) {
  for (const Camera& camera : other_cameras()) {
    DesignOptions options;
    options.baselines = {"hamiltonian-k4"};
    options.trials = 4000;
    options = with_effort(options, 0.0);
    const DesignResult result = design(camera, options);
    std::vector<Candidate> lent;
    for (const CodeSet& code : nearest_atlas_codes(code_atlas(), camera, {}, 1))
      lent.push_back({.code = code, .method = "atlas"});
    ASSERT_FALSE(lent.empty());
    const DesignResult alone = judge(camera, lent, options);
    const DepthErrorKind kind = camera.operating.error;
    const Estimate of_lent = alone.winner().error.of(kind).geometric_mean_m;
    EXPECT_LE(geometric_mean_error_m(result.winner().error, kind),
              of_lent.value + 2.0 * of_lent.standard_error);
  }
}

TEST(Atlas, SearchesNothingWithoutEffort) {
  const Camera camera = other_cameras().front();
  DesignOptions options;
  options.trials = 2000;
  options = with_effort(options, 0.0);
  const DesignResult result = design(camera, options);
  bool has_atlas = false, has_family = false;
  for (const Candidate& c : result.candidates) {
    EXPECT_FALSE(c.is_designed()) << c.code.name();
    has_atlas |= c.method == "atlas";
    has_family |= c.method == "family";
  }
  EXPECT_TRUE(has_atlas && has_family);
  EXPECT_THAT(result.explanation.front(), HasSubstr("no code was designed"));
  options.atlas_cameras = 0;
  for (const Candidate& c : design(camera, options).candidates) EXPECT_EQ(c.method, "family");
}

TEST(Atlas, DesignsThatStartFromItAreBitIdenticalForAnyNumberOfThreads) {
  const Camera camera = other_cameras().front();
  DesignOptions options;
  options.method = DesignMethod::optimize;
  options.exposures = {4};
  options.baselines.emplace();
  options.trials = 1000;
  options = with_effort(options, 0.01);
  options.optimize.steps_per_start = 20;
  options.optimize.polish_steps = 5;
  std::vector<DesignResult> results;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    results.push_back(design(camera, options));
  }
  const Candidate* designed = results[0].find("optimized-k4");
  ASSERT_NE(designed, nullptr);
  EXPECT_THAT(designed->message, HasSubstr("gradient descent from atlas-4x1"));
  expect_same_code(results[0].winner().code, results[1].winner().code);
}

TEST(Atlas, FitRecoversTheLawOfItsEntries) {
  std::vector<AtlasEntry> entries;
  for (const double band : {3.0, 5.0, 10.0, 20.0})
    for (const double peak : {2.0, 8.0}) {
      AtlasEntry entry = parse_atlas(one_code)[0];
      entry.of.bandwidth_f0 = band;
      entry.of.peak_factor = peak;
      entry.linear_m.value = 2.0 / band / std::sqrt(peak);
      entries.push_back(entry);
    }
  const auto law = fit_atlas_law(entries);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->at_ones_m, 2.0, 1e-9);
  EXPECT_NEAR(law->bandwidth_power, 1.0, 1e-9);
  EXPECT_NEAR(law->peak_power, 0.5, 1e-9);
  EXPECT_NEAR(law->max_residual, 0.0, 1e-9);
  EXPECT_EQ(law->entries, 8);
  for (AtlasEntry& entry : entries) entry.of.peak_factor = 2.0;
  EXPECT_FALSE(fit_atlas_law(entries));
  EXPECT_FALSE(fit_atlas_law({entries[0]}));
}

TEST(Atlas, BestByExposuresKeepsTheLowestError) {
  AtlasEntry three = parse_atlas(one_code)[0], four = three;
  four.of.exposures = 4;
  four.linear_m.value = 0.1;
  AtlasEntry circular = three;
  circular.of.error = DepthErrorKind::circular;
  const auto best = best_by_exposures({three, four, circular});
  ASSERT_EQ(best.size(), 2u);
  EXPECT_EQ(best[0].of, four.of);
  EXPECT_EQ(best[1].of, circular.of);
}

TEST(Atlas, CodesOfEveryCameraCanBeFittedToEveryPeak) {
  for (const double peak_factor : {1.2, 2.0, 3.0, 5.0, 7.5, 15.0, 25.0, 40.0})
    for (const AtlasEntry& entry : code_atlas()) {
      const CodeSet fitted = fitted_to_peak(entry.code, entry.of.peak_factor, peak_factor);
      EXPECT_LE(fitted.peak(), peak_factor * (1 + 1e-9)) << entry.code.name();
    }
}

Camera power_limited() {
  Camera camera = coarse_camera("paper-30x");
  camera.light.peak_factor = 5.0;
  return camera;
}

/// With gates of any duty, ambient light cancels in few differences of taps.
Camera analog_difference() {
  Camera camera = coarse_camera("paper-10f0");
  const double f0_hz = camera.fundamental_frequency_hz;
  camera.light.peak_factor = 25.0;
  camera.light.impulse_response.f_max_hz = 3 * f0_hz;
  camera.sensor.impulse_response.f_max_hz = 13 * f0_hz;
  camera.sensor.taps = 2;
  camera.sensor.binary = false;
  camera.sensor.readout = Readout::difference;
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e6};
  return camera;
}

TEST(Design, ReturnsACodeIfNoAtlasCodeIsUsable) {
  DesignOptions options = with_effort({}, 0.0);
  options.trials = 1000;
  options.baselines = {"sinusoid-k4", "hamiltonian-k4"};
  for (const Camera& camera : {power_limited(), analog_difference()}) {
    const DesignResult result = design(camera, options);
    EXPECT_EQ(why_not_playable(result.winner().code, camera), std::nullopt);
  }
}

TEST(Design, RejectsConstantLightWithThatReason) {
  Camera camera = coarse_camera("paper-10f0");
  camera.light.peak_factor = 1.0;
  EXPECT_THAT([&] { design(camera, with_effort({}, 0.0)); },
              ThrowsMessage<InvalidArgument>(
                  "light.peak_factor = 1; allows only constant light, which cannot measure depth"));
}

TEST(Atlas, IsReadIdenticallyInEveryLocale) {
  const GermanLocale locale;
  EXPECT_EQ(parse_atlas(one_code)[0].code.name(), "atlas-3x1-peak4-hann10-linear");
  EXPECT_EQ(parse_atlas(one_code)[0].circular_m.standard_error, 0.0005);
}

}  // namespace
}  // namespace tofsmith
