// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/shared/random.hpp"
#include "rows_setup.hpp"
#include "simulate/shared/error_by_rotation.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith {

namespace {

using Weights = std::optional<std::vector<double>>;

Camera small_camera(Weights depths = {}) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 60;
  camera.operating.signal_e_per_s = {1e4};
  camera.operating.ambient_e_per_s = {1e3};
  camera.operating.depths = std::move(depths);
  return camera;
}

std::vector<double> only(int part, int parts) {
  std::vector<double> weights(static_cast<std::size_t>(parts), 0.0);
  weights[static_cast<std::size_t>(part)] = 2.0;
  return weights;
}

void expect_same_bits(const CodeSet& code, const Camera& one, const Camera& other) {
  for (const DepthSampling depth : {DepthSampling::uniform, DepthSampling::bins}) {
    const EvaluateOptions options{.trials = 2000, .depth = depth};
    const DepthErrorReport a = evaluate(code, one, options), b = evaluate(code, other, options);
    EXPECT_EQ(a.linear.mean_m.value, b.linear.mean_m.value);
    EXPECT_EQ(a.circular.mean_m.value, b.circular.mean_m.value);
    EXPECT_EQ(a.points[0].cramer_rao_mae_m, b.points[0].cramer_rao_mae_m);
    EXPECT_EQ(a.points[0].receiver_bound_mae_m, b.points[0].receiver_bound_mae_m);
  }
  EXPECT_EQ(best_rotation(code, one, {.trials = 2000}).linear_geometric_mean_m,
            best_rotation(code, other, {.trials = 2000}).linear_geometric_mean_m);
}

TEST(WeighedDepths, EqualWeightsAndTheScaleOfWeightsDoNotChangeABit) {
  const Camera none = small_camera(), even = small_camera(std::vector<double>(12, 0.3));
  Camera whole = none;
  whole.operating.working_distance_m = {0.0, none.range_m()};
  const CodeSet code = build_family("hamiltonian-k4", none);
  expect_same_bits(code, none, even);
  expect_same_bits(code, none, whole);
  expect_same_bits(code, small_camera(Weights({0.0, 1.0, 3.0})),
                   small_camera(Weights({0.0, 4.0, 12.0})));
}

TEST(WeighedDepths, AWorkingDistanceEqualsWeightsOfOneWithinIt) {
  const Camera weighed = small_camera(Weights({0.0, 1.0, 1.0, 0.0}));
  Camera within = small_camera();
  within.operating.working_distance_m = {0.25 * within.range_m(), 0.75 * within.range_m()};
  const CodeSet code = build_family("hamiltonian-k4", within);
  const PointDepthError a = evaluate(code, weighed, {.trials = 4000}).points[0],
                        b = evaluate(code, within, {.trials = 4000}).points[0];
  EXPECT_NEAR(a.linear_mde_m.value, b.linear_mde_m.value, 1e-3 * a.linear_mde_m.value);
  EXPECT_NEAR(a.cramer_rao_mae_m, b.cramer_rao_mae_m, 1e-9 * a.cramer_rao_mae_m);
  EXPECT_NEAR(a.receiver_bound_mae_m, b.receiver_bound_mae_m, 1e-9 * a.receiver_bound_mae_m);
}

TEST(WeighedDepths, TheErrorIsTheWeightedMeanOverParts) {
  constexpr int parts = 5;
  const CodeSet code = build_family("hamiltonian-k4", small_camera());
  std::vector<PointDepthError> of_part;
  for (int part = 0; part < parts; ++part)
    of_part.push_back(
        evaluate(code, small_camera(only(part, parts)), {.trials = 20000, .seed = 3}).points[0]);
  for (const Weights& weights : {Weights(), Weights({1.0, 0.0, 4.0, 2.0, 1.0})}) {
    double linear_m = 0.0, circular_m = 0.0, bound_m = 0.0, variance_m2 = 0.0;
    for (std::size_t part = 0; part < parts; ++part) {
      const double weight = weights ? (*weights)[part] / 8 : 1.0 / parts;
      linear_m += weight * of_part[part].linear_mde_m.value;
      circular_m += weight * of_part[part].circular_mde_m.value;
      bound_m += weight * of_part[part].cramer_rao_mae_m;
      variance_m2 += std::pow(weight * of_part[part].linear_mde_m.standard_error, 2);
    }
    const PointDepthError all = evaluate(code, small_camera(weights), {.trials = 40000}).points[0];
    const double deviation_m = std::hypot(all.linear_mde_m.standard_error, std::sqrt(variance_m2));
    EXPECT_NEAR(all.linear_mde_m.value, linear_m, 4 * deviation_m);
    EXPECT_NEAR(all.circular_mde_m.value, circular_m, 4 * deviation_m);
    EXPECT_NEAR(all.cramer_rao_mae_m, bound_m, 1e-9 * bound_m);
  }
}

TEST(WeighedDepths, ANarrowPeakGivesTheErrorOfThatDepth) {
  Camera camera = small_camera();
  camera.operating.signal_e_per_s = {1e6};  // errors are small and normal
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const Eigen::VectorXd sigma_m =
      CramerRaoBound(ForwardModel(code, camera), camera).sigma_m(camera.operating.points()[0]);
  for (const int cell : {33, 90, 177}) {
    camera.operating.depths = only(cell, 240);
    const PointDepthError error = evaluate(code, camera, {.trials = 20000}).points[0];
    const double there_m = std::sqrt(2.0 / std::numbers::pi) * sigma_m[cell];
    EXPECT_NEAR(error.cramer_rao_mae_m, there_m, 1e-9 * there_m);
    EXPECT_NEAR(error.circular_mde_m.value, there_m, 0.15 * there_m) << cell;
  }
}

TEST(WeighedDepths, OnBinsTheyUseTheBinBelow) {
  Camera camera = small_camera(Weights(only(7, 60)));
  camera.operating.signal_e_per_s = {1e8};  // only the rounding error of depths remains
  const CodeSet code = build_family("hamiltonian-k3", camera);
  EvaluateOptions options{.trials = 200, .sub_bin = false};
  const double bin_m = camera.bin_m();
  EXPECT_NEAR(evaluate(code, camera, options).points[0].circular_mde_m.value, bin_m / 4,
              bin_m / 10);
  options.depth = DepthSampling::bins;
  EXPECT_EQ(evaluate(code, camera, options).points[0].circular_mde_m.value, 0.0);
}

TEST(WeighedDepths, ErrorsByRotationMatchTrialsRotatedOneByOne) {
  constexpr int samples = 24;
  const DepthPrior prior({0.0, 3.0, 1.0, 0.0, 2.0});
  const Eigen::VectorXd weight = samples * prior.masses(samples);
  for (const DepthErrorKind kind : {DepthErrorKind::linear, DepthErrorKind::circular}) {
    WeighedErrorByRotation errors(prior, kind, samples);
    std::vector<double> expected(samples, 0.0);
    RandomStream random(5, 1);
    for (int t = 0; t < 500; ++t) {
      const double truth = std::floor(samples * random.uniform());
      const double decoded = samples * random.uniform();
      errors.add(truth, decoded);
      for (int r = 0; r < samples; ++r) {
        const auto seen = [&](double bin) { return bin < r ? bin - r + samples : bin - r; };
        const double error = std::abs(seen(decoded) - seen(truth));
        expected[static_cast<std::size_t>(r)] +=
            weight[static_cast<Eigen::Index>(seen(truth))] *
            (kind == DepthErrorKind::linear ? error : std::min(error, samples - error));
      }
    }
    const std::vector<double> sums = errors.sums();
    for (std::size_t r = 0; r < samples; ++r) EXPECT_NEAR(sums[r], expected[r], 1e-9) << r;
  }
}

TEST(ErrorByRotation, MeansAreOverOriginsWithinHalfABin) {
  constexpr int samples = 12, per_bin = 8;
  ErrorByRotation errors(samples), odd_trials(samples);
  std::vector<double> expected(samples, 0.0);
  RandomStream random(5, 2);
  for (int t = 0; t < 500; ++t) {
    const auto depth = [&] { return std::floor(samples * per_bin * random.uniform()) / per_bin; };
    const double truth = depth(), decoded = depth();
    (t % 2 == 0 ? errors : odd_trials).add(truth, decoded);
    for (int r = 0; r < samples; ++r)
      for (int part = 0; part < per_bin; ++part) {  // depths are never at these origins
        const double origin = r - 0.5 + (part + 0.5) / per_bin;
        const auto seen = [&](double bin) {
          return bin - origin - samples * std::floor((bin - origin) / samples);
        };
        expected[static_cast<std::size_t>(r)] += std::abs(seen(decoded) - seen(truth)) / per_bin;
      }
  }
  errors.merge(odd_trials);
  const std::vector<double> means = errors.means_over_origins();
  ASSERT_EQ(means.size(), expected.size());
  for (std::size_t r = 0; r < samples; ++r) EXPECT_NEAR(means[r], expected[r], 1e-9) << r;
}

TEST(WeighedDepths, TheBestRotationPredictsTheErrorOfTheRotatedCode) {
  for (const DepthErrorKind kind : {DepthErrorKind::linear, DepthErrorKind::circular}) {
    Camera camera = small_camera(Weights({0, 0, 3, 1, 0, 0, 0, 0, 0, 2}));
    camera.operating.error = kind;
    const CodeSet code = build_family("hamiltonian-k4", camera);
    const BestRotation found = best_rotation(code, camera, {.trials = 60000});
    for (const int r : {0, 17, found.rotation_bin}) {
      const Estimate error =
          evaluate(code.rotated(r), camera, {.trials = 60000, .seed = 9}).of(kind).geometric_mean_m;
      EXPECT_NEAR(found.linear_geometric_mean_m[static_cast<std::size_t>(r)], error.value,
                  0.05 * error.value + 4 * error.standard_error)
          << r;
    }
  }
}

TEST(WeighedDepths, NoCodeBeatsTheReceiverBound) {
  Camera camera = small_camera();
  camera.operating.signal_e_per_s = {1e6};
  const CodeSet code = build_family("hamiltonian-k4", camera);
  for (int part = 0; part < 20; ++part) {
    camera.operating.depths = only(part, 20);
    const PointDepthError error = evaluate(code, camera, {.trials = 2000}).points[0];
    EXPECT_LT(error.receiver_bound_mae_m, error.cramer_rao_mae_m) << part;
  }
}

TEST(WeighedDepths, TheHistogramBoundIsTheMeanOverThemWithinABin) {
  Camera camera = small_camera();
  camera.sensor.readout = Readout::rows;
  camera.sensor.read_noise_e = 0.0;
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const OperatingPoint point = camera.operating.points()[0];
  const auto mae_m = [&] {
    return HistogramBound(ForwardModel(code, camera), camera).mae_m(point);
  };
  const double anywhere_m = mae_m();
  double sum_m = 0.0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    camera.operating.depths = only(4 * 13 + quarter, 240);
    sum_m += mae_m();
  }
  EXPECT_NEAR(sum_m / 4, anywhere_m, 1e-9 * anywhere_m);
}

/// Depths do not wrap here, so that linear and circular error are equal.
Camera camera_of_the_middle() {
  Camera camera = small_camera(Weights({0, 0, 0, 1, 1, 0, 0, 0}));
  camera.operating.signal_e_per_s = {1e6};
  return camera;
}

TEST(WeighedDepths, MultipathOfTheOperatingRangeUsesThem) {
  Camera camera = camera_of_the_middle();
  const CodeSet code = build_family("sinusoid-k4", camera);
  const OperatingMultipath later{.ratio = {0.1, 0.3}, .delay_m = {0.2, 0.5}};
  const OperatingMultipathError error =
      operating_multipath_report(code, camera, later, {.trials = 2000}, {}).single_path;
  EXPECT_EQ(error.linear_m.value, error.circular_m.value);
  camera.operating.depths.reset();
  const OperatingMultipathError anywhere =
      operating_multipath_report(code, camera, later, {.trials = 2000}, {}).single_path;
  EXPECT_GT(anywhere.linear_m.value, anywhere.circular_m.value);
}

TEST(WeighedDepths, MultipathMapsAreTheMeanOverThem) {
  constexpr int parts = 5;
  Camera camera = small_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  MultipathErrorOptions options{
      .delay_m = {0.5}, .ratio = {0.3}, .tail_m = {0.5}, .signal_e_per_s = {1e5}, .trials = 600};
  const auto cell = [&] { return multipath_error(code, camera, options).maps[0].points[0]; };
  const Eigen::VectorXd sigma_m = Eigen::ArrayXd::LinSpaced(camera.samples, 0.1, 0.3).square();
  const auto mean_bound_m = [&] {
    return MultipathBound(ForwardModel(code, camera), camera).mae_m(sigma_m);
  };
  const MultipathCell all = cell();
  const double all_bound_m = mean_bound_m();
  double error_m = 0.0, bound_m = 0.0, largest_m = 0.0, smallest_m = 1.0;
  for (int part = 0; part < parts; ++part) {
    camera.operating.depths = only(part, parts);
    const MultipathCell there = cell();
    error_m += there.single_error_m.value / parts;
    bound_m += mean_bound_m() / parts;
    EXPECT_NE(mean_bound_m(), all_bound_m) << part;
    largest_m = std::max(largest_m, there.single_error_m.value);
    smallest_m = std::min(smallest_m, there.single_error_m.value);
  }
  EXPECT_NEAR(error_m, all.single_error_m.value, 6 * all.single_error_m.standard_error);
  EXPECT_GT(largest_m - smallest_m, 6 * all.single_error_m.standard_error);
  EXPECT_NEAR(bound_m, all_bound_m, 1e-9 * bound_m);
}

}  // namespace

}  // namespace tofsmith
