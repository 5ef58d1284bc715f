// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_shares.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shared/random.hpp"
#include "design/exposure_split.hpp"
#include "design/optimize/optimized_code.hpp"
#include "design_setup.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/motion_error.hpp"

namespace tofsmith {

namespace {

Eigen::VectorXd random_vector(int size, std::uint64_t seed) {
  RandomStream random(seed, 1);
  Eigen::VectorXd values(size);
  for (double& value : values) value = 2.0 * random.normal();
  return values;
}

/// Logarithm of the root of a sum of variances that are inversely proportional to the shares.
ShareObjective sum_of_variances(const Eigen::VectorXd& variance) {
  return [variance](const Eigen::VectorXd& shares, Eigen::VectorXd& by_shares) {
    const Eigen::ArrayXd each = variance.array() / shares.array();
    by_shares = -0.5 * each / shares.array() / each.sum();
    return 0.5 * std::log(each.sum());
  };
}

TEST(ExposureShares, HaveTheSumOneAndASmallestValue) {
  for (int exposures = 1; exposures <= 8; ++exposures)
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Eigen::VectorXd shares = shares_of_logits(3.0 * random_vector(exposures, seed));
      EXPECT_NEAR(shares.sum(), 1.0, 1e-12);
      EXPECT_GE(shares.minCoeff(), min_exposure_share);
    }
}

TEST(ExposureShares, LogitsGiveTheSameSharesBack) {
  const Eigen::VectorXd shares{{0.4, 0.3, 0.25, 0.05}};
  EXPECT_TRUE(shares_of_logits(logits_of_shares(shares)).isApprox(shares, 1e-12));
  const Eigen::VectorXd smallest{{min_exposure_share, 1.0 - min_exposure_share}};
  EXPECT_TRUE(shares_of_logits(logits_of_shares(smallest)).isApprox(smallest, 1e-3));
}

TEST(ExposureShares, GradientMatchesFiniteDifferences) {
  const Eigen::VectorXd weights = random_vector(5, 3), along = random_vector(5, 4);
  const Eigen::VectorXd logits = 0.3 * random_vector(5, 5);
  constexpr double step = 1e-6;
  const double slope = (weights.dot(shares_of_logits(logits + step * along)) -
                        weights.dot(shares_of_logits(logits - step * along))) /
                       (2.0 * step);
  EXPECT_NEAR(pull_back_shares(shares_of_logits(logits), weights).dot(along), slope, 1e-8);
}

TEST(ExposureShares, AreProportionalToStandardDeviationsThatAdd) {
  const Eigen::VectorXd variance{{1.0, 9.0, 4.0, 0.25}};
  const Eigen::VectorXd shares =
      minimize_over_shares(Eigen::VectorXd::Constant(4, 0.25), sum_of_variances(variance));
  const Eigen::VectorXd expected = variance.cwiseSqrt() / variance.cwiseSqrt().sum();
  EXPECT_TRUE(shares.isApprox(expected, 1e-4)) << shares.transpose();
}

TEST(ExposureShares, OfExposuresWithoutInformationAreTheSmallest) {
  const Eigen::VectorXd variance{{0.0, 1.0, 4.0}};
  const Eigen::VectorXd shares =
      minimize_over_shares(Eigen::VectorXd::Constant(3, 1.0 / 3), sum_of_variances(variance));
  EXPECT_NEAR(shares[0], min_exposure_share, 1e-9);
  EXPECT_NEAR(shares[1], 0.33, 1e-4);
  EXPECT_NEAR(shares.sum(), 1.0, 1e-12);
}

Camera bright_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 120;
  camera.operating.signal_e_per_s = {1e6, 1e7};
  camera.operating.ambient_e_per_s = {1e5};
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

CodeSet with_shares(const CodeSet& code, const Eigen::VectorXd& shares) {
  return code.with_exposure_shares({shares.begin(), shares.end()});
}

TEST(ExposureBound, IsTheCramerRaoBoundInBrightLight) {
  Camera camera = bright_camera();
  camera.sensor.read_noise_e = 20.0;
  camera.sensor.dark_current_e_per_s = 1e4;
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const Eigen::VectorXd shares{{0.1, 0.2, 0.3, 0.4}};
  const CramerRaoBound exact(ForwardModel(with_shares(code, shares), camera), camera,
                             NoiseInformation::mean, 1);
  double expected = 0.0;
  for (const OperatingPoint& point : camera.operating.points())
    expected += 0.5 * std::log(exact.sigma_m(point).mean());
  EXPECT_NEAR(ExposureBound(code, camera).log_deviation(shares), expected, 1e-4);
}

TEST(ExposureBound, GradientMatchesFiniteDifferences) {
  std::vector<Camera> cameras(4, bright_camera());
  cameras[0].sensor.read_noise_e = 100.0;
  cameras[0].operating.signal_e_per_s = {1e3, 1e5};
  cameras[1].sensor.taps = 2;
  cameras[1].sensor.readout = Readout::difference;
  cameras[1].operating.uniform_albedo = true;
  cameras[2].operating.statistic = ErrorStatistic::rmse;
  cameras[2].sensor.dark_current_e_per_s = 1e6;
  cameras[3].operating.depths = {{3.0, 0.0, 1.0}};
  cameras[3].operating.neighbours = 9;
  const Eigen::VectorXd shares{{0.15, 0.2, 0.3, 0.35}};
  for (const Camera& camera : cameras) {
    const ExposureBound bound(build_family("hamiltonian-k4", camera), camera);
    Eigen::VectorXd gradient;
    bound.log_deviation(shares, gradient);
    for (Eigen::Index e = 0; e < shares.size(); ++e) {
      constexpr double step = 1e-6;
      Eigen::VectorXd up = shares, down = shares;
      up[e] += step;
      down[e] -= step;
      EXPECT_NEAR(gradient[e], (bound.log_deviation(up) - bound.log_deviation(down)) / (2 * step),
                  1e-5 * gradient.norm());
    }
  }
}

TEST(ExposureBound, SharesFollowTheOrderOfTheCode) {
  Camera camera = bright_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const Eigen::VectorXd shares = ExposureBound(code, camera).best_shares();
  camera.playback.emplace();
  camera.playback->order = {2, 0, 3, 1};
  EXPECT_TRUE(ExposureBound(code, camera).best_shares().isApprox(shares, 1e-6));
}

TEST(ExposureBound, EqualTimesAreBestForEquivalentExposures) {
  const Camera camera = bright_camera();
  const Eigen::VectorXd shares =
      ExposureBound(build_family("sinusoid-k4", camera), camera).best_shares();
  EXPECT_TRUE(shares.isApprox(Eigen::VectorXd::Constant(4, 0.25), 1e-3)) << shares.transpose();
}

TEST(ExposureBound, BestSharesHaveTheSmallestBoundOfAllSplitsBetweenTwoFrequencies) {
  Camera camera = bright_camera();
  camera.sensor.read_noise_e = 200.0;
  const CodeSet code = build_family("multifrequency-1x4-2x4", camera);
  const ExposureBound bound(code, camera);
  const double least = bound.log_deviation(bound.best_shares());
  for (double low = min_exposure_share; low < 0.24; low += 0.002) {
    Eigen::VectorXd shares = Eigen::VectorXd::Constant(8, low);
    shares.tail(4).setConstant(0.25 - low);
    EXPECT_GE(bound.log_deviation(shares), least - 1e-7) << low;
  }
}

using testing::HasSubstr;

Camera bright_fine_camera() {
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
  Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
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

TEST(ExposureSplit, ReachesTheGainPredictedByTheBound) {
  const Camera camera = bright_fine_camera();
  const CodeSet even = build_family("multifrequency-1x4-7x4", camera);
  const ExposureBound bound(even, camera);
  const double predicted = bound.gain(bound.best_shares());
  EXPECT_GT(predicted, 1.15);
  EXPECT_GT(new_error_m(even, camera) / new_error_m(with_split_exposures(even, camera, {}), camera),
            0.97 * predicted);
}

TEST(ExposureSplit, IsNeverWorseThanEqualTimes) {
  constexpr double tolerance = 0.004;  // of the trials
  Camera dim = bright_fine_camera();
  dim.operating.signal_e_per_s = {3e3, 3e4};
  dim.operating.ambient_e_per_s = {1e4};
  for (const Camera& camera : {bright_fine_camera(), dim})
    for (const char* name : {"hamiltonian-k4", "pulsed-multifrequency-k5", "square-k4"}) {
      const CodeSet even = build_family(name, camera);
      const CodeSet split = with_split_exposures(even, camera, {});
      EXPECT_LE(new_error_m(split, camera), (1.0 + tolerance) * new_error_m(even, camera)) << name;
    }
}

TEST(ExposureSplit, SupportsAnyNumberOfPolishSteps) {
  const Camera camera = bright_fine_camera();
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
  const Camera camera = bright_fine_camera();
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

Camera moving_camera() {
  Camera camera = coarse_camera("paper-10f0", DepthErrorKind::circular);
  camera.exposure_s.total_s = 20e-3;
  camera.operating.velocity_m_per_s = 1.0;
  return camera;
}

double rms_bias_m(const CodeSet& code, const Camera& camera) {
  return MotionBias(ForwardModel(code, camera), camera).rms_m(exposure_shifts_m(code, camera, 1.0));
}

TEST(ExposureOrder, IsTheBestOfAll) {
  const Camera camera = moving_camera();
  const CodeSet hamiltonian = build_family("hamiltonian-k4", camera);
  for (const CodeSet& code :
       {build_family("sinusoid-k4", camera), build_family("square-k4", camera), hamiltonian,
        hamiltonian.with_exposure_shares({0.1, 0.4, 0.3, 0.2})}) {
    const ExposureOrder found = best_exposure_order(code, camera, 1.0);
    EXPECT_NEAR(found.given_rms_bias_m, rms_bias_m(code, camera), 1e-12) << code.name();
    EXPECT_NEAR(found.rms_bias_m, rms_bias_m(code.with_exposure_order(found.order), camera), 1e-9);
    std::vector<int> order{0, 1, 2, 3};
    do {
      EXPECT_LE(found.rms_bias_m, rms_bias_m(code.with_exposure_order(order), camera) + 1e-8);
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(ExposureOrder, KeepsTheExposuresOfAFrequencyTogether) {
  const Camera camera = moving_camera();
  for (const char* name : {"multifrequency-1x4-7x4", "multifrequency-1x5-7x5"}) {
    const CodeSet code = build_family(name, camera);
    const ExposureOrder found = best_exposure_order(code, camera, 1.0);
    EXPECT_EQ(code.with_exposure_order(found.order).frequency_starts().size(), 2u) << name;
    EXPECT_LT(found.rms_bias_m, found.given_rms_bias_m) << name;
  }
}

TEST(ExposureOrder, IsKeptIfTheCameraListsValuesForExposures) {
  Camera camera = moving_camera();
  camera.exposure_s.each_s = {5e-3, 5e-3, 5e-3, 5e-3};
  const CodeSet code = build_family("sinusoid-k4", camera);
  EXPECT_EQ(best_exposure_order(code, camera, 1.0).order, (std::vector{0, 1, 2, 3}));
}

TEST(ExposureOrder, OfCandidatesIsChosenForTheVelocityOfTheCamera) {
  const Camera camera = moving_camera();
  const CodeSet code = build_family("sinusoid-k4", camera);
  const DesignOptions options = small_options();
  const DesignResult moving = judge(camera, {{.code = code, .method = "family"}}, options);
  const Candidate& winner = moving.winner();
  ASSERT_TRUE(winner.exposure_order);
  EXPECT_EQ(winner.exposure_order->order, (std::vector{0, 1, 3, 2}));
  EXPECT_LT(rms_bias_m(winner.code, camera), 1e-6);
  EXPECT_EQ(winner.code.name(), code.name());
  EXPECT_NE(moving.explanation.back().find("reordered to 0, 1, 3, 2"), std::string::npos);

  Camera still = camera;
  still.operating.velocity_m_per_s.reset();
  const DesignResult same = judge(still, {{.code = code, .method = "family"}}, options);
  EXPECT_FALSE(same.winner().exposure_order);
  const Estimate &moved = winner.error.circular.geometric_mean_m,
                 &given = same.winner().error.circular.geometric_mean_m;
  EXPECT_NEAR(moved.value, given.value,
              4.0 * std::hypot(moved.standard_error, given.standard_error));
}

TEST(ExposureOrder, AlsoAppliesToTargetsAndReportsOfMeasurements) {
  Camera camera = moving_camera();
  camera.sensor.taps = 2;
  Candidate candidate{.code = build_family("sinusoid-k4", camera), .method = "factorize"};
  candidate.target.resize(1, 4);
  candidate.target << 0, 1, 2, 3;
  for (int i = 0; i < 4; ++i) candidate.per_measurement.push_back({.edges = i});
  Candidate of_taps = candidate;
  for (int i = 4; i < 8; ++i) of_taps.per_measurement.push_back({.edges = i});
  choose_exposure_order(camera, candidate);
  choose_exposure_order(camera, of_taps);
  const std::vector<int>& order = candidate.exposure_order->order;
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end()));
  for (std::size_t e = 0; e < 4; ++e) {
    EXPECT_EQ(candidate.target(0, static_cast<Eigen::Index>(e)), order[e]);
    EXPECT_EQ(candidate.per_measurement[e].edges, order[e]);
    EXPECT_EQ(of_taps.per_measurement[2 * e].edges, 2 * order[e]);
    EXPECT_EQ(of_taps.per_measurement[2 * e + 1].edges, 2 * order[e] + 1);
  }
}

}  // namespace

}  // namespace tofsmith
