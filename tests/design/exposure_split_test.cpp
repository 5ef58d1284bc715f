// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_split.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "design/exposure_bound.hpp"
#include "design/optimize/split_search.hpp"
#include "same_code.hpp"
#include "small_design.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

Camera bright_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e6};
  camera.operating.ambient_e_per_s = {1e5};
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

double new_error_m(const CodeSet& code, const Camera& camera) {
  const EvaluateOptions fresh{.trials = 20000, .seed = 77, .bounds = false};
  return evaluate(code, camera, fresh).circular.geometric_mean_m.value;
}

/// A search for this camera takes a fraction of a second.
Camera fast_camera() {
  Camera camera = small_camera("paper-10f0", DepthErrorKind::circular);
  camera.light.peak_factor = 6.0;
  camera.operating.signal_e_per_s = {1e6};
  return camera;
}

OptimizeOptions fast_search() {
  OptimizeOptions options;
  options.samples = 48;
  options.starts = 4;
  options.steps_per_start = 30;
  options.hops = 4;
  options.steps_per_hop = 30;
  options.refinement_steps = 30;
  options.polish_steps = 40;
  options.trials_per_step = 60;
  options.pool_trials = 4000;
  return options;
}

TEST(ExposureSplit, GivesTheExposuresThatMeasureDepthMoreTime) {
  const Camera camera = bright_camera();
  const CodeSet even = build_family("multifrequency-1x4-7x4", camera);
  const CodeSet split = with_split_exposures(even, camera, {});
  ASSERT_EQ(split.exposure_shares().size(), 8u);
  const std::vector<double>& shares = split.exposure_shares();
  EXPECT_LT(std::accumulate(shares.begin(), shares.begin() + 4, 0.0), 0.4);
}

TEST(ExposureSplit, ReachesTheGainPredictedByTheBound) {
  const Camera camera = bright_camera();
  const CodeSet even = build_family("multifrequency-1x4-7x4", camera);
  const ExposureBound bound(even, camera);
  const double predicted = bound.gain(bound.best_shares());
  EXPECT_GT(predicted, 1.15);
  EXPECT_GT(new_error_m(even, camera) / new_error_m(with_split_exposures(even, camera, {}), camera),
            0.97 * predicted);
}

TEST(ExposureSplit, IsNeverWorseThanEqualTimes) {
  constexpr double tolerance = 0.004;  // of the trials
  Camera dim = bright_camera();
  dim.operating.signal_e_per_s = {3e3, 3e4};
  dim.operating.ambient_e_per_s = {1e4};
  for (const Camera& camera : {bright_camera(), dim})
    for (const char* name : {"hamiltonian-k4", "pulsed-multifrequency-k5", "square-k4"}) {
      const CodeSet even = build_family(name, camera);
      const CodeSet split = with_split_exposures(even, camera, {});
      EXPECT_LE(new_error_m(split, camera), (1.0 + tolerance) * new_error_m(even, camera)) << name;
    }
}

TEST(ExposureSplit, SupportsAnyNumberOfPolishSteps) {
  const Camera camera = bright_camera();
  const CodeSet even = build_family("multifrequency-1x4-7x4", camera);
  for (const int steps : {0, 1, 2}) {
    DesignOptions options;
    options.optimize.polish_steps = steps;
    EXPECT_EQ(with_split_exposures(even, camera, options).exposure_shares().size(), 8u) << steps;
  }
}

TEST(ExposureSplit, SupportsCamerasWithoutBandLimit) {
  Camera camera = built_in_camera("mlx75027");
  camera.operating.signal_e_per_s = {1e8};
  camera.operating.ambient_e_per_s = {1e7};
  const CodeSet even = build_family("multifrequency-1x2-5x2", camera);
  EXPECT_FALSE(with_split_exposures(even, camera, {}).exposure_shares().empty());
}

TEST(ExposureSplit, LeavesCamerasThatListTimesAlone) {
  Camera camera = built_in_camera("paper-10f0");
  camera.exposure_s.each_s = {0.1, 0.1, 0.1, 0.1};
  DesignResult result;
  result.candidates.push_back({.code = build_family("square-k4", camera), .method = "optimize"});
  add_split_exposures(camera, {}, result, {});
  EXPECT_EQ(result.candidates.size(), 1u);
}

TEST(ExposureSplit, OfADesignReportsTheGainAndTheBound) {
  const Camera camera = bright_camera();
  DesignResult result;
  const CodeSet even = build_family("multifrequency-1x4-7x4", camera);
  result.candidates.push_back({.code = even, .method = "factorize", .message = "given"});
  add_split_exposures(camera, {}, result, {});
  ASSERT_EQ(result.candidates.size(), 2u);
  EXPECT_TRUE(result.candidates[0].code.exposure_shares().empty());
  EXPECT_THAT(result.candidates[1].message, HasSubstr("given; exposures of different length: 1."));
  EXPECT_THAT(result.candidates[1].message, HasSubstr("times smaller error (bound: 1."));
}

TEST(SplitSearch, KeepsTheCodesOfEqualTimes) {
  const Camera camera = fast_camera();
  const std::vector<Candidate> equal = optimize(camera, 5, fast_search());
  const std::vector<Candidate> split = optimize_with_shares({&camera, 1}, 5, fast_search(), {}, {});
  ASSERT_GE(split.size(), equal.size());
  for (std::size_t i = 0; i < equal.size(); ++i) {
    EXPECT_TRUE(split[i].code.exposure_shares().empty());
    expect_same_code(split[i].code, equal[i].code);
  }
}

// So short a search finds shares that gain enough with about every third seed.
TEST(SplitSearch, FindsBetterCodesWithSharesForAnyNumberOfThreads) {
  const Camera camera = fast_camera();
  OptimizeOptions search = fast_search();
  std::vector<Candidate> found;
  while (found.size() < 2u) {
    ASSERT_LE(++search.seed, 20u);
    found = optimize_with_shares({&camera, 1}, 5, search, {}, {});
  }
  const CodeSet& split = found.back().code;
  ASSERT_EQ(split.exposure_shares().size(), 5u);
  EXPECT_LT(new_error_m(split, camera), 0.99 * new_error_m(found.front().code, camera));
  const ThreadLimit one(1);
  const CodeSet again = optimize_with_shares({&camera, 1}, 5, search, {}, {}).back().code;
  expect_same_functions(again, split);
  EXPECT_EQ(again.exposure_shares(), split.exposure_shares());
}

TEST(SplitSearch, NeverMakesADesignWorse) {
  for (const DesignMethod method : {DesignMethod::optimize, DesignMethod::factorize}) {
    DesignOptions options = small_options({4});
    options.method = method;
    options.optimize = fast_search();
    const Camera camera = fast_camera();
    const double equal_m = design(camera, options).winner().code.provenance.depth_error_m;
    options.split_exposures = true;
    EXPECT_LE(design(camera, options).winner().code.provenance.depth_error_m, equal_m);
  }
}

TEST(SplitSearch, RejectsCamerasThatListTimes) {
  Camera camera = fast_camera();
  camera.exposure_s.each_s = {0.1, 0.1, 0.1, 0.1};
  EXPECT_THROW(optimize_with_shares({&camera, 1}, 4, fast_search(), {}, {}), InvalidArgument);
}

}  // namespace
}  // namespace tofsmith
