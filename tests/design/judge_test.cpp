// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/shared/random.hpp"
#include "design/baselines.hpp"
#include "design_setup.hpp"
#include "simulate/shared/error_by_rotation.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

Candidate candidate_of(const std::string& family, const Camera& camera,
                       const std::string& name = {}) {
  const CodeSet code = build_family(family, camera);
  return {.code = name.empty() ? code : code.renamed(name), .method = "family"};
}

std::vector<Candidate> families(const Camera& camera) {
  return {candidate_of("sinusoid-k4", camera), candidate_of("hamiltonian-k4", camera),
          candidate_of("square-k4", camera)};
}

/// Compares all but the error that judge() stores in the code.
void expect_same_waveforms(const CodeSet& judged, CodeSet code) {
  code.provenance.depth_error_m = judged.provenance.depth_error_m;
  expect_same_code(judged, code);
}

TEST(Judge, RanksLikeDesign) {
  const Camera camera = coarse_camera("paper-5f0");
  const DesignOptions options = small_options();
  DesignStore store;
  std::vector<Candidate> made;
  store.save = [&](const std::string&, const std::vector<Candidate>& candidates) {
    made = candidates;
  };
  const DesignResult designed = design(camera, options, {}, store);
  for (const Candidate& c : made) {
    EXPECT_TRUE(c.error.points.empty()) << "makers judge nothing";
    EXPECT_EQ(c.rotation_bin, 0);
  }
  const DesignResult judged = judge(camera, made, options);
  const Candidate& from_design = *designed.find("hamiltonian-k3-factorized");
  expect_same_waveforms(judged.winner().code, from_design.code);
  EXPECT_EQ(judged.winner().rotation_bin, from_design.rotation_bin);
  // design() may have used more trials, because it also ranks other codes.
  const Estimate &alone = judged.winner().error.linear.geometric_mean_m,
                 &among_others = from_design.error.linear.geometric_mean_m;
  EXPECT_NEAR(alone.value, among_others.value,
              3.0 * std::hypot(alone.standard_error, among_others.standard_error));
}

TEST(Judge, EvaluatesCodesCloseToTheBestWithMoreTrials) {
  Camera camera = coarse_camera("paper-10f0");
  const DesignOptions options = small_options();
  const auto trials_of = [&](const DesignResult& result, const char* name) {
    return result.find(name)->error.trials / options.trials;
  };
  std::vector<Candidate> codes = {candidate_of("hamiltonian-k4", camera),
                                  candidate_of("sinusoid-k4", camera),
                                  candidate_of("hamiltonian-k4", camera, "equal")};
  const DesignResult alone = judge(camera, {codes[0], codes[1]}, options);
  EXPECT_EQ(trials_of(alone, "hamiltonian-k4"), 1);
  const DesignResult result = judge(camera, codes, options);
  EXPECT_EQ(trials_of(result, "hamiltonian-k4"), 12);
  EXPECT_EQ(trials_of(result, "equal"), 12);
  EXPECT_EQ(trials_of(result, "sinusoid-k4"), 1);
  std::reverse(codes.begin(), codes.end());
  const DesignResult reversed = judge(camera, codes, options);
  for (const Candidate& c : result.candidates)
    EXPECT_EQ(c.error.linear.geometric_mean_m.value,
              reversed.find(c.code.name())->error.linear.geometric_mean_m.value);
  camera.operating.multipath = OperatingMultipath{};
  EXPECT_EQ(trials_of(judge(camera, codes, options), "equal"), 1);
}

TEST(Judge, StopsOnRequestWithinACode) {
  const Camera camera = coarse_camera("paper-10f0");
  DesignOptions options = small_options();
  options.trials = 100'000'000;
  double stopped_at = 0.0;
  const auto stop = [&](double fraction, std::string_view) {
    stopped_at = fraction;
    return fraction == 0.0;
  };
  EXPECT_THROW(judge(camera, {candidate_of("hamiltonian-k4", camera)}, options, stop), Interrupted);
  EXPECT_GT(stopped_at, 0.0);
  EXPECT_LT(stopped_at, 0.5);
}

TEST(Judge, CountsOutliersBeyondTheConfiguredThreshold) {
  const Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
  DesignOptions options = small_options();
  const DesignResult usual = judge(camera, families(camera), options);
  options.outlier_threshold_m = 0.01;
  const DesignResult strict = judge(camera, families(camera), options);
  ASSERT_EQ(strict.candidates.size(), usual.candidates.size());
  for (std::size_t c = 0; c < usual.candidates.size(); ++c) {
    const DepthErrorReport &few = usual.candidates[c].error, &many = strict.candidates[c].error;
    EXPECT_EQ(few.outlier_threshold_m, 0.5);
    EXPECT_EQ(many.outlier_threshold_m, 0.01);
    EXPECT_EQ(many.circular.geometric_mean_m.value, few.circular.geometric_mean_m.value);
    EXPECT_GT(many.points[0].outlier_rate.value, few.points[0].outlier_rate.value);
  }
}

TEST(Judge, KeepsTheBestOfCandidatesWithEqualNames) {
  const Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
  std::vector<Candidate> attempts = {candidate_of("sinusoid-k4", camera, "mine"),
                                     candidate_of("square-k4", camera),
                                     candidate_of("hamiltonian-k4", camera, "mine")};
  const DesignResult better = judge(camera, attempts, small_options());
  std::swap(attempts.front(), attempts.back());
  const DesignResult same = judge(camera, attempts, small_options());
  for (const DesignResult& result : {better, same}) {
    ASSERT_EQ(result.candidates.size(), 2u);
    EXPECT_EQ(result.candidates[0].code.name(), "mine");
    expect_same_waveforms(result.candidates[0].code,
                          candidate_of("hamiltonian-k4", camera, "mine").code);
    EXPECT_EQ(result.winner().code.name(), "mine");
  }
}

TEST(Judge, ExcludesCodesWithoutDepthInformation) {
  const Camera camera = coarse_camera("paper-10f0");
  std::vector<Candidate> candidates = families(camera);
  const std::vector<Waveform> flat(3, Waveform::constant(1.0));
  candidates.push_back({.code = CodeSet::create("flat", camera.samples, 1, flat, flat),
                        .method = "mine",
                        .message = "nothing moves"});
  const DesignResult result = judge(camera, candidates, small_options());
  EXPECT_EQ(result.find("flat"), nullptr);
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_THAT(result.left_out[0], HasSubstr("flat (nothing moves): rank"));
  EXPECT_THROW(judge(camera, {candidates.back()}, small_options()), std::invalid_argument);
}

TEST(Judge, CountsAllShiftsOfTheOrigin) {
  const Camera camera = coarse_camera("paper-5f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const DesignResult once = judge(camera, {{.code = code, .method = "family"}}, small_options());
  const DesignResult twice = judge(camera, once.candidates, small_options());
  const int first_bin = once.winner().rotation_bin;
  ASSERT_NE(first_bin, 0);
  expect_same_waveforms(once.winner().code, code.rotated(first_bin));
  const int moved_bin = (twice.winner().rotation_bin + camera.samples - first_bin) % camera.samples;
  expect_same_waveforms(twice.winner().code, once.winner().code.rotated(moved_bin));
}

TEST(BestOfRotations, IsTheFirstOfTheSmallestAndIdempotent) {
  EXPECT_EQ(best_of_rotations({3.0, 1.0, 2.0, 1.0}), 1);
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    RandomStream random(5, trial);
    std::vector<double> errors(60);
    for (double& error : errors) error = std::floor(8.0 * random.uniform());  // with ties
    std::vector<double> moved = errors;
    std::ranges::rotate(moved, moved.begin() + best_of_rotations(errors));
    EXPECT_EQ(best_of_rotations(moved), 0) << "a code at its best origin stays there";
    moved = errors;
    std::ranges::rotate(moved, moved.begin() + best_of_rotations(smoothed_over_rotations(errors)));
    EXPECT_EQ(best_of_rotations(smoothed_over_rotations(moved)), 0);
  }
}

TEST(WhyNoDepth, CoversAllReasonsForNotMeasuringDepth) {
  const Camera camera = coarse_camera("paper-10f0");
  EXPECT_FALSE(why_no_depth(build_family("hamiltonian-k4", camera), camera));
  Camera dim = camera;
  dim.light.peak_factor = 1.0;
  EXPECT_THAT(*why_no_depth(build_family("hamiltonian-k4", camera), dim), HasSubstr("peak"));
}

TEST(SuggestedBaselines, MatchTheMethod) {
  const Camera camera = coarse_camera("paper-10f0");
  DesignOptions options;
  EXPECT_EQ(suggested_baselines(camera, options).size(), 8u);
  options.method = DesignMethod::factorize;
  EXPECT_THAT(suggested_baselines(camera, options),
              ElementsAre("hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5"));
  options.exposures = {4};
  EXPECT_THAT(suggested_baselines(camera, options), ElementsAre("hamiltonian-k4"));
  options.exposures = {};
  options.target = targets_of(build_family("square-k3", camera));
  EXPECT_TRUE(suggested_baselines(camera, options).empty());
}

TEST(OtherFamilies, AreAllSuitableBuiltInCodesIfFewEnough) {
  const Camera camera = built_in_camera("paper-10f0");
  std::vector<std::string> names = other_families(camera, {});
  const std::vector<std::string> shown = suggested_baselines(camera, {});
  names.insert(names.end(), shown.begin(), shown.end());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const FamilyDescription& family : list_families())
    EXPECT_TRUE(why_no_family(family.example, camera) ||
                std::find(names.begin(), names.end(), family.example) != names.end())
        << family.example;
  for (const char* low : {"pulsed-multifrequency-k4-q", "pulsed-multifrequency-k5-q"})
    for (const int q : {2, 4, 5, 6}) EXPECT_THAT(names, Contains(fmt::format("{}{}", low, q)));
  for (const std::string& name : names) EXPECT_FALSE(why_no_family(name, camera)) << name;
  Camera wide = camera;  // passes 400 harmonics
  wide.light.impulse_response.f_max_hz = wide.sensor.impulse_response.f_max_hz = 6e9;
  EXPECT_LT(other_families(wide, {}).size(), 400u);
}

TEST(ContendingFamilies, IncludeTheBestOfAllFamilies) {
  for (const auto& [taps, kind] :
       {std::pair(1, DepthErrorKind::linear), std::pair(2, DepthErrorKind::circular)}) {
    Camera camera = coarse_camera("paper-10f0", kind);
    camera.sensor.taps = taps;
    std::vector<std::string> names = other_families(camera, {});
    std::erase_if(names, [](const std::string& name) { return name.find("-1x4") < name.size(); });
    std::vector<Candidate> all;
    for (const std::string& name : names)
      if (const CodeSet code = build_family(name, camera); !why_no_depth(code, camera))
        all.push_back({.code = code, .method = "family"});
    DesignOptions options = small_options();
    options.exposures = {};  // the winner may have any number
    const std::string best = judge(camera, all, options).winner().code.name();
    const Contenders contenders = contending_families(names, camera, 2);
    EXPECT_LE(contenders.codes.size(), 8u);
    EXPECT_TRUE(std::any_of(contenders.codes.begin(), contenders.codes.end(),
                            [&](const CodeSet& code) { return code.name() == best; }))
        << best;
    std::size_t listed = contenders.codes.size();
    for (const auto& [reason, left_out] : contenders.left_out) listed += left_out.size();
    EXPECT_EQ(listed, names.size()) << "each competes or has a reason";
  }
}

TEST(ContendingFamilies, TheBestAtlasCodeIsFoundForEverySeedAndEqualOnesCountOnce) {
  Camera camera = built_in_camera("paper-10f0");
  camera.fundamental_frequency_hz = 31.4e6;
  camera.sensor.taps = 2;
  camera.light.peak_factor = 13.4;
  camera.light.impulse_response.f_max_hz = camera.sensor.impulse_response.f_max_hz = 336e6;
  camera.operating.error = DepthErrorKind::linear;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    std::vector<std::string> of_four_exposures;
    const std::vector<CodeSet> codes = contending_atlas_codes(camera, {.seed = seed}).codes;
    for (const CodeSet& code : codes) {
      if (code.exposures() == 4) of_four_exposures.push_back(code.name());
      EXPECT_EQ(std::ranges::count_if(
                    codes, [&](const CodeSet& other) { return has_same_waveforms(code, other); }),
                1)
          << code.name();
    }
    EXPECT_THAT(of_four_exposures, testing::Contains("atlas-4x2-peak8-hann10-linear")) << seed;
  }
}

TEST(ContendingFamilies, ReportWhyOthersCannotCompete) {
  Camera camera = coarse_camera("paper-10f0");
  camera.sensor.taps = 2;
  camera.sensor.shortest_pulse_s = 0.2 / camera.fundamental_frequency_hz;
  const Contenders contenders =
      contending_families({"single-ramp-k3", "square-k4", "nothing-k4"}, camera, 2);
  std::string listed;
  for (const auto& [reason, names] : contenders.left_out)
    listed += fmt::format("{}: {}\n", fmt::join(names, ","), reason);
  EXPECT_THAT(listed,
              HasSubstr("single-ramp-k3: has pulses or gaps below sensor.shortest_pulse_s"));
  EXPECT_THAT(listed, HasSubstr("nothing-k4: code = nothing-k4"));
  ASSERT_EQ(contenders.codes.size(), 1u) << listed;
}

TEST(Design, TriesEveryBuiltInCodeAndReportsThoseNotJudged) {
  Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
  camera.sensor.taps = 2;
  DesignOptions options = small_options();
  options.method = DesignMethod::optimize;
  options.baselines = {};
  options.exposures = {2};
  options.optimize.starts = 1;
  options.optimize.steps_per_start = options.optimize.polish_steps = 1;
  options.optimize.hops = options.optimize.refinement_steps = 0;
  options.optimize.pool_trials = 1000;
  const DesignResult result = design(camera, options);
  EXPECT_NE(result.find("sinusoid-k4"), nullptr) << "shown, however it does";
  EXPECT_THAT(result.left_out, Contains(HasSubstr("times the error of the best standard code")));
  EXPECT_NE(by_geometric_mean_error(result, DepthErrorKind::circular)
                .front()
                ->code.name()
                .find("pulsed-multifrequency-k4-q"),
            std::string::npos);
}

TEST(RankingError, IsOfTheKindAndStatisticOfTheCamera) {
  Camera camera = coarse_camera("paper-10f0");
  Candidate candidate = candidate_of("sinusoid-k4", camera);
  candidate.error.linear.geometric_mean_m.value = 1.0;
  candidate.error.circular.geometric_mean_m.value = 2.0;
  candidate.error.linear_rmse.geometric_mean_m.value = 3.0;
  candidate.error.circular_rmse.geometric_mean_m.value = 4.0;
  EXPECT_EQ(camera.operating.statistic, ErrorStatistic::mae);
  double expected = 1.0;
  for (const ErrorStatistic statistic : {ErrorStatistic::mae, ErrorStatistic::rmse})
    for (const DepthErrorKind kind : {DepthErrorKind::linear, DepthErrorKind::circular}) {
      camera.operating.error = kind;
      camera.operating.statistic = statistic;
      EXPECT_EQ(ranking_error_m(candidate, camera, {}), expected++);
    }
}

TEST(Judge, RejectsRootMeanSquaresWhereOnlyMeansAreKnown) {
  Camera camera = coarse_camera("paper-10f0");
  camera.operating.statistic = ErrorStatistic::rmse;
  DesignOptions options = small_options();
  options.robust = true;
  EXPECT_THAT([&] { judge(camera, {}, options); },
              ThrowsMessage<InvalidArgument>(HasSubstr("operating.statistic = rmse; must be")));
  options.robust = false;
  camera.operating.multipath = OperatingMultipath{};
  EXPECT_THAT([&] { judge(camera, {}, options); },
              ThrowsMessage<InvalidArgument>(HasSubstr("operating.statistic = rmse; must be")));
}

TEST(Judge, RanksByTheErrorWithOtherCameras) {
  Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
  camera.operating.signal_e_per_s = {1e6};
  camera.operating.ambient_e_per_s = {1e5};
  const DesignOptions options = small_options();
  const DesignResult alone = judge(camera, families(camera), options);
  EXPECT_FALSE(alone.winner().interference);
  camera.operating.interference = OperatingInterference{.cameras = 2, .signal_ratio = 0.2};
  const DesignResult result = judge(camera, families(camera), options);
  for (const Candidate& c : result.candidates) {
    ASSERT_TRUE(c.interference);
    const double error_m = c.interference->circular.geometric_mean_m.value;
    EXPECT_EQ(ranking_error_m(c, camera, options), error_m);
    EXPECT_GT(error_m, c.error.circular.geometric_mean_m.value);
    EXPECT_LE(result.winner().interference->circular.geometric_mean_m.value, error_m);
    EXPECT_EQ(c.error.circular.geometric_mean_m.value,
              alone.find(c.code.name())->error.circular.geometric_mean_m.value);
  }
  EXPECT_THAT(result.explanation,
              Contains(HasSubstr("With the light of 2 other cameras, each 0.2 times the signal")));
  DesignOptions robust = options;
  robust.robust = true;
  EXPECT_THAT([&] { judge(camera, families(camera), robust); },
              ThrowsMessage<InvalidArgument>(HasSubstr("operating.interference")));
}

TEST(DesignSeed, IsPassedToFactorization) {
  const Camera camera = coarse_camera("paper-5f0");
  DesignOptions options = small_options();
  options.factorize.structured_starts = false;
  const auto factorized = [&](std::uint64_t seed, std::uint64_t factorize_seed) {
    options.seed = seed;
    options.factorize.seed = factorize_seed;
    return design(camera, options).find("hamiltonian-k3-factorized")->code;
  };
  expect_same_code(factorized(7, 1), factorized(7, 2));
}

using testing::Not;

std::string limit_of(double bound_over_error) {
  const Camera camera = coarse_camera("paper-10f0");
  DesignResult result = judge(
      camera, {{.code = build_family("sinusoid-k4", camera), .method = "family"}}, small_options());
  for (PointDepthError& p : result.candidates[0].error.points)
    p.cramer_rao_mae_m = bound_over_error * p.circular_mde_m.value;
  return explain(camera, result)[2];
}

TEST(Explanation, NeverReportsAnErrorBelowItsBoundAsARatio) {
  EXPECT_THAT(limit_of(0.8), HasSubstr("1.25 times the Cramer-Rao bound of the code"));
  EXPECT_THAT(limit_of(100), HasSubstr("correlation functions are nearly flat at some depth"));
  EXPECT_THAT(limit_of(100), Not(HasSubstr("times the Cramer-Rao bound of the code")));
}

}  // namespace

}  // namespace tofsmith
