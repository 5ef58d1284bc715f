// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/design/optimize.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "design/optimize/optimize_pool.hpp"
#include "design/optimize/optimize_starts.hpp"
#include "design/optimize/optimized_code.hpp"
#include "design_setup.hpp"
#include "refusal.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// An optimization for this camera takes milliseconds.
Camera small_camera(DepthErrorKind error = DepthErrorKind::circular) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = 6.0;
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e4};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = error;
  return camera;
}

OptimizeOptions small_options() {
  OptimizeOptions options;
  options.samples = 48;
  options.starts = 4;
  options.steps_per_start = 40;
  options.hops = 5;
  options.steps_per_hop = 20;
  options.refinement_steps = 60;
  options.polish_steps = 20;
  options.trials_per_step = 60;
  options.pool_trials = 1000;
  return options;
}

/// The period is cyclic; the result is in periods.
double shortest_run(const Waveform& waveform) {
  const std::vector<OnInterval>& on = waveform.on_intervals();
  double shortest = 1.0;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const double next = i + 1 < on.size() ? on[i + 1].rise : on[0].rise + 1.0;
    shortest = std::min({shortest, on[i].fall - on[i].rise, next - on[i].fall});
  }
  return shortest;
}

/// Removes the given codes.
DesignResult judged(const Camera& camera, std::vector<Candidate> candidates,
                    const std::vector<CodeSet>& given = {}) {
  for (const CodeSet& code : given) candidates.push_back({.code = code, .method = "family"});
  DesignOptions options;
  options.trials = 4000;
  options.seed = 12345;
  return judge(camera, std::move(candidates), options);
}

TEST(Optimize, AWorkingDistanceReducesTheErrorThere) {
  for (const DepthErrorKind kind : {DepthErrorKind::circular, DepthErrorKind::linear}) {
    const Camera anywhere = small_camera(kind);
    Camera near = anywhere;
    near.operating.depths = {0, 1, 1, 0, 0, 0, 0, 0, 0, 0};
    const double of_near_m = judged(near, optimize(near, 4, small_options()))
                                 .winner()
                                 .error.of(kind)
                                 .geometric_mean_m.value;
    const double of_all_m = judged(near, optimize(anywhere, 4, small_options()))
                                .winner()
                                .error.of(kind)
                                .geometric_mean_m.value;
    EXPECT_LT(of_near_m, 0.9 * of_all_m);
  }
}

TEST(Optimize, ReturnsUnjudgedCandidates) {
  const Camera camera = small_camera();
  const std::vector<CodeSet> also = {build_family("hamiltonian-k4", camera)};
  const std::vector<Candidate> candidates = optimize(camera, 4, small_options(), also);
  ASSERT_EQ(candidates.size(), 1u);
  for (const Candidate& c : candidates) {
    EXPECT_EQ(c.code.name(), "optimized-k4");
    EXPECT_EQ(c.method, "optimize");
    EXPECT_TRUE(c.is_designed());
    EXPECT_FALSE(why_not_playable(c.code, camera));
    EXPECT_TRUE(c.error.points.empty());
    EXPECT_FALSE(c.robustness);
    EXPECT_EQ(c.rotation_bin, 0);
    EXPECT_EQ(c.code.provenance.method, "optimize");
    EXPECT_EQ(c.code.provenance.camera, camera.name);
    EXPECT_GT(c.iterations, 0);
  }
  EXPECT_THAT(candidates[0].message, HasSubstr("with refined edges"));
}

TEST(Optimize, BeatsTheHamiltonianCodeThatItStartsFrom) {
  const Camera camera = small_camera();
  const std::vector<CodeSet> also = {build_family("hamiltonian-k4", camera)};
  const DesignResult result = judged(camera, optimize(camera, 4, small_options(), also), also);
  ASSERT_EQ(result.candidates.size(), 2u) << "the better attempt, and the code given";
  EXPECT_EQ(result.winner().code.name(), "optimized-k4");
  EXPECT_LT(result.winner().error.circular.geometric_mean_m.value,
            0.97 * result.find("hamiltonian-k4")->error.circular.geometric_mean_m.value);
}

TEST(Optimize, AccountsForTheMultipathOfTheCamera) {
  Camera camera = small_camera();
  camera.sensor.taps = 2;
  camera.operating.signal_e_per_s = {1e5};
  const std::vector<CodeSet> also = {build_family("hamiltonian-k5", camera)};
  const OperatingMultipath later{{0.2, 0.5}, {0.5, 3.0}, 0.5};
  camera.operating.multipath = later;
  const DesignResult result = judged(camera, optimize(camera, 5, small_options(), also), also);
  const Candidate& given = *result.find("hamiltonian-k5");
  const Candidate& found = *result.find("optimized-k5");
  ASSERT_TRUE(given.multipath && given.multipath->two_return);
  ASSERT_TRUE(found.multipath && found.multipath->two_return);
  // The ranking error is smaller, and two returns can still be separated.
  EXPECT_LT(ranking_error_m(found, camera, {}), ranking_error_m(given, camera, {}));
  EXPECT_LT(found.multipath->two_return->circular_m.value,
            1.4 * given.multipath->two_return->circular_m.value);
}

TEST(Optimize, KeepsEveryPulseAndGapAtTheRequiredLength) {
  for (const bool band_limited : {false, true}) {
    Camera camera = small_camera();
    if (!band_limited) camera.light.impulse_response = camera.sensor.impulse_response = {};
    for (const double shortest_periods : {1.0 / 45.5, 1.0 / 13.0}) {
      camera.sensor.shortest_pulse_s = shortest_periods / camera.fundamental_frequency_hz;
      const CodeSet code = optimize(camera, 3, small_options()).back().code;
      for (int e = 0; e < 3; ++e) {
        EXPECT_TRUE(code.modulation(e).is_binary());
        EXPECT_GE(shortest_run(code.modulation(e)), shortest_periods - 1e-9);
        EXPECT_GE(shortest_run(code.demodulation(e)), shortest_periods - 1e-9);
        EXPECT_LE(code.modulation(e).peak(), camera.light.peak_factor * (1 + 1e-9));
        EXPECT_NEAR(code.modulation(e).mean(), 1.0, 1e-9);
      }
    }
  }
}

TEST(Optimize, RequiresAShortestPulseWithoutAnotherLimit) {
  Camera camera = small_camera();
  camera.light.impulse_response = camera.sensor.impulse_response = {};
  EXPECT_THAT(refusal_of([&] { optimize(camera, 4, small_options()); }),
              AllOf(HasSubstr("sensor.shortest_pulse_s"), HasSubstr("2.2e-09")));
  camera.sensor.shortest_pulse_s = suggested_shortest_pulse_s(camera);
  EXPECT_NO_THROW(optimize(camera, 4, small_options()));
}

TEST(Optimize, RejectsUnsupportedCameras) {
  Camera camera = small_camera();
  EXPECT_THROW(optimize(camera, 2, small_options()), std::invalid_argument);
  EXPECT_THROW(optimize(camera, 9, small_options()), std::invalid_argument);
  camera.light.peak_factor = 1.0;
  EXPECT_THROW(optimize(camera, 4, small_options()), std::invalid_argument);
  OptimizeOptions bad = small_options();
  bad.starts = 0;
  EXPECT_THROW(optimize(small_camera(), 4, bad), std::invalid_argument);
  EXPECT_THROW(optimize(std::span<const Camera>(), 4, small_options()), std::invalid_argument);
}

TEST(Optimize, ExclusiveTapsUseTheDrainOnlyIfThereIsOne) {
  Camera camera = small_camera();
  camera.sensor.taps = 3;
  camera.sensor.modulation_contrast = 0.9;
  for (const bool drain : {true, false}) {
    camera.sensor.drain = drain;
    const CodeSet code = optimize(camera, 1, small_options()).back().code;
    const Eigen::VectorXd sum = code.demodulation_samples().rowwise().sum();
    EXPECT_LE(sum.maxCoeff(), 1.0 + 1e-9);
    if (!drain) {
      EXPECT_GE(sum.minCoeff(), 1.0 - 1e-9);
    }
  }
}

TEST(Optimize, DifferencesOfBucketsCancelAmbientLight) {
  Camera camera = small_camera();
  camera.sensor.taps = 2;
  camera.sensor.readout = Readout::difference;
  const CodeSet code = optimize(camera, 2, small_options()).back().code;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(code.demodulation(i).mean(), 0.5, 1e-9);
}

TEST(Optimize, NonBinaryArmsUseAnyValue) {
  Camera camera = small_camera();
  camera.light.binary = false;
  const CodeSet code = optimize(camera, 3, small_options()).back().code;
  EXPECT_FALSE(code.modulation(0).is_binary());
  EXPECT_TRUE(code.demodulation(0).is_binary());
  EXPECT_LE(code.peak(), camera.light.peak_factor * (1 + 1e-9));
  EXPECT_LE(code.modulation(0).mean(), 1.0 + 1e-9);
}

TEST(Optimize, MinimizesTheErrorOfTheWorstVariant) {
  std::vector<Camera> variants(2, small_camera());
  variants[1].light.impulse_response.f_max_hz *= 0.3;
  OptimizeOptions options = small_options();
  options.trials_per_step = 200;  // half of them for each variant
  options.pool_trials = 4000;
  const auto worst_m = [&](const std::vector<Candidate>& found) {
    double worst_m = 0.0;
    for (const Camera& variant : variants)
      worst_m =
          std::max(worst_m, evaluate(found.back().code, variant).circular.geometric_mean_m.value);
    return worst_m;
  };
  EXPECT_LT(worst_m(optimize(variants, 4, options)),
            worst_m(optimize(variants.front(), 4, options)));
}

TEST(Optimize, HistoryNeverRisesAndStopsEarlyWithoutGain) {
  OptimizeOptions options = small_options();
  options.hops = 40;
  options.steps_per_hop = 1;
  options.patience = 5;
  const Candidate found = optimize(small_camera(), 3, options).front();
  for (std::size_t i = 1; i < found.search->steps.size(); ++i) {
    EXPECT_LE(found.search->steps[i].error_m, found.search->steps[i - 1].error_m);
    EXPECT_EQ(found.search->steps[i].work, found.search->steps[i - 1].work + 1);
  }
  EXPECT_THAT(found.message, HasSubstr("stopped early without further gain"));
}

TEST(Optimize, EndsEarlyOnlyIfAnotherNumberOfExposuresIsClearlyBetter) {
  const Camera camera = small_camera();
  DesignOptions options;
  options.optimize = small_options();
  options.optimize.starts = 12;
  options.optimize.hops = 15;
  options.optimize.patience = 0;
  const auto best = [&](double rival_m) {
    return optimized_candidates(camera, 3, options, {}, rival_m, {}).front();
  };
  const Candidate alone = best(infinity);
  const double error_m = error_to_beat_m(camera, options, std::span(&alone, 1));
  EXPECT_EQ(error_m, alone.search->steps.back().error_m);
  expect_same_code(best(error_m).code, alone.code);
  const std::vector<SearchStep>& steps = alone.search->steps;
  const double start_m = steps[static_cast<std::size_t>(options.optimize.starts) - 1].error_m;
  const Candidate after_ten = best(start_m / 1.5), after_starts = best(start_m / 1.25),
                  after_hops = best(start_m / 1.15);
  EXPECT_LT(after_ten.search->steps.size(), after_starts.search->steps.size());
  EXPECT_LT(after_starts.search->steps.size(), after_hops.search->steps.size());
  EXPECT_LT(after_hops.search->steps.size(), steps.size());
  for (const Candidate& lost : {after_ten, after_starts, after_hops})
    EXPECT_THAT(lost.message, HasSubstr("another number of exposures is better"));
}

TEST(Optimize, DesignsTellSearchesTheErrorToBeat) {
  const Camera camera = small_camera();
  DesignOptions options;
  options.method = DesignMethod::optimize;
  options.optimize = small_options();
  options.optimize.hops = 15;
  options.baselines.emplace();
  options.trials = 1000;
  const int best_number =
      optimizable_exposures(camera, options, contending_atlas_codes(camera, options)).front();
  Candidate best = optimize(camera, best_number, small_options()).front();
  best.search->steps = {{1.0, 1e-6}};
  std::vector<std::string> messages;
  const DesignStore store{.load =
                              [&](const std::string& name) {
                                return name == optimized_name(best_number)
                                           ? std::vector{best}
                                           : std::vector<Candidate>{};
                              },
                          .save =
                              [&](const std::string&, const std::vector<Candidate>& made) {
                                messages.push_back(made.front().message);
                              }};
  design(camera, options, {}, store);
  EXPECT_THAT(messages, testing::SizeIs(2));
  EXPECT_THAT(messages, testing::Each(HasSubstr("another number of exposures is better")));
}

TEST(Optimize, HasNoErrorToBeatIfExposuresAreListedOrAnotherCriterionRanks) {
  Candidate made{.code = build_family("hamiltonian-k3", small_camera()), .method = "optimize"};
  made.search = SearchRecord{.steps = {{1, 0.5}, {2, 0.2}}};
  const auto to_beat_m = [&](const Camera& camera, const DesignOptions& options) {
    return error_to_beat_m(camera, options, std::span(&made, 1));
  };
  EXPECT_EQ(to_beat_m(small_camera(), {}), 0.2);
  EXPECT_EQ(to_beat_m(small_camera(), {.exposures = {3, 4}}), infinity);
  EXPECT_EQ(to_beat_m(small_camera(), {.split_exposures = true}), infinity);
  EXPECT_EQ(to_beat_m(small_camera(), {.robust = true}), infinity);
  Camera multipath = small_camera(), squares = multipath, saturating = multipath;
  multipath.operating.multipath = OperatingMultipath();
  squares.operating.statistic = ErrorStatistic::rmse;
  saturating.sensor.full_well_e = 1e4;
  for (const Camera& camera : {multipath, squares, saturating})
    EXPECT_EQ(to_beat_m(camera, {}), infinity);
  made.method = "factorize";
  EXPECT_EQ(to_beat_m(small_camera(), {}), infinity);
}

double amplitude_of_frequency_1(const Eigen::VectorXd& samples) {
  std::complex<double> sum = 0.0;
  for (Eigen::Index n = 0; n < samples.size(); ++n)
    sum += std::polar(samples[n], -2.0 * std::numbers::pi * static_cast<double>(n) /
                                      static_cast<double>(samples.size()));
  return std::abs(sum) / static_cast<double>(samples.size());
}

DesignProblem problem_for(int taps, int exposures) {
  Camera camera = small_camera();
  camera.sensor.taps = taps;
  return make_design_problem(std::span(&camera, 1), exposures, 48);
}

TEST(FrequencyMixtures, BeginWithFrequency1EndWithAHigherOneAndDiffer) {
  for (const int taps : {1, 2, 3, 4})
    for (const int exposures : {3, 5, 8}) {
      const DesignProblem problem = problem_for(taps, exposures);
      const std::vector<OptimizeStart> mixtures = frequency_mixtures(problem);
      ASSERT_FALSE(mixtures.empty());
      for (auto it = mixtures.begin(); it != mixtures.end(); ++it) {
        const Eigen::MatrixXd light = render(problem.space, it->parameters, {6.0, 8.0}).modulation;
        EXPECT_GT(amplitude_of_frequency_1(light.col(0)), 0.5) << it->name;
        EXPECT_LT(amplitude_of_frequency_1(light.col(exposures - 1)), 0.2) << it->name;
        for (auto other = mixtures.begin(); other != it; ++other)
          EXPECT_TRUE(it->parameters.modulation != other->parameters.modulation ||
                      it->parameters.demodulation != other->parameters.demodulation)
              << it->name << ", " << other->name;
      }
    }
  EXPECT_TRUE(frequency_mixtures(problem_for(2, 2)).empty());
}

TEST(FrequencyMixtures, TheBestAreOfDifferentFrequenciesAndNestedForAnyNumber) {
  const DesignProblem problem = problem_for(2, 5);
  const std::vector<OptimizeStart> many = best_mixtures(problem, 12, 1);
  ASSERT_EQ(many.size(), 12u);
  for (std::size_t i = 0; i < many.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(many[i].name, many[j].name);
  const std::vector<OptimizeStart> few = best_mixtures(problem, 3, 1);
  ASSERT_EQ(few.size(), 3u);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].name, many[i].name);
    EXPECT_EQ(few[i].parameters.demodulation, many[i].parameters.demodulation);
  }
  EXPECT_TRUE(best_mixtures(problem, -1, 1).empty());
}

TEST(BestOfStarts, TakesTheFirstEntriesOfEveryStart) {
  std::vector<PoolEntry> pool(5);
  const std::vector<std::size_t> starts = {7, 7, 7, 2, 7};
  for (std::size_t i = 0; i < pool.size(); ++i) {
    pool[i].start = "random gates, one pulse";
    pool[i].start_index = starts[i];
  }
  EXPECT_THAT(best_of_starts(pool, 3, 2), testing::ElementsAre(0, 1, 3));
  EXPECT_THAT(best_of_starts(pool, 2, 2), testing::ElementsAre(0, 1));
  EXPECT_THAT(best_of_starts(pool, 9, 1), testing::ElementsAre(0, 3));
}

TEST(OptimizableExposures, AreTheNumbersOfTheBestAtlasCodesUnlessListed) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = 12.0;
  camera.light.impulse_response.f_max_hz = camera.sensor.impulse_response.f_max_hz = 195e6;
  const auto of = [&](const DesignOptions& options) {
    return optimizable_exposures(camera, options, contending_atlas_codes(camera, options));
  };
  EXPECT_THAT(of({}), testing::Contains(6));
  EXPECT_EQ(of({}).size(), 3u);
  EXPECT_EQ(of({}).front(), contending_atlas_codes(camera, {}).codes.front().exposures());
  EXPECT_THAT(of({.exposures = {4}}), testing::ElementsAre(4));
  EXPECT_EQ(of({.atlas_cameras = 0}), suggested_exposures(camera, DesignMethod::optimize));
}

TEST(Optimize, StopsOnRequest) {
  int calls = 0;
  EXPECT_THROW(optimize(small_camera(), 3, small_options(), {},
                        [&](double fraction, std::string_view) {
                          EXPECT_GE(fraction, 0.0);
                          EXPECT_LE(fraction, 1.0);
                          return ++calls < 3;
                        }),
               Interrupted);
}

}  // namespace
}  // namespace tofsmith
