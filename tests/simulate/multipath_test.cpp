// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/shared/special_functions.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Camera two_bucket_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  return camera;
}

SceneImage flat_scene(int width) {
  SceneImage scene(1, width);
  for (int i = 0; i < width; ++i) scene.depth_m(0, i) = 1.0f + 0.7f * static_cast<float>(i);
  return scene;
}

/// A camera with electron noise only, and enough light to make it negligible.
struct Noiseless {
  Camera camera = two_bucket_camera();
  CodeSet code;
  ForwardModel model;
  CaptureOptions options{.signal_e_per_s = 1e14, .ambient_e_per_s = 0.0, .falloff = false};

  Noiseless() : code(build_family("hamiltonian-k5", camera)), model(code, camera) {}

  Eigen::VectorXd measured(const SceneImage& scene, const SceneLight& light, int pixel) const {
    const RawFrames raw = capture(scene, light, code, camera, options);
    Eigen::VectorXd values(raw.measurements);
    for (int k = 0; k < raw.measurements; ++k)
      values[k] = raw.frame(0)[pixel * raw.measurements + k];
    return values;
  }
  void expect_close(const Eigen::VectorXd& found, const std::vector<Return>& returns) const {
    const Eigen::VectorXd expected = model.expected_electrons(returns, 0.0);
    EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());
  }
};

TEST(ExponentialAverage, OfAHarmonicIsItsTransform) {
  constexpr int rows = 4800;
  Eigen::MatrixXd table(rows, 2);
  for (int n = 0; n < rows; ++n) {
    table(n, 0) = std::cos(2 * M_PI * n / rows);
    table(n, 1) = std::sin(2 * M_PI * n / rows);
  }
  const double mean = 0.1 * rows, w = 2 * M_PI * 0.1;
  const Eigen::MatrixXd average = exponential_average(table, mean);
  // Mean of exp(i (x + u w)) over exponential u: exp(i x) / (1 - i w).
  EXPECT_NEAR(average(0, 0), 1 / (1 + w * w), 1e-6);
  EXPECT_NEAR(average(0, 1), w / (1 + w * w), 1e-6);
  EXPECT_NEAR(average.col(0).sum(), 0.0, 1e-8);
}

TEST(MultipathCapture, AddsReturnsTailAndTransientLikeTheModel) {
  const Noiseless setup;
  const SceneImage scene = flat_scene(3);
  const double bin_m = setup.camera.bin_m(), s = setup.options.signal_e_per_s;
  const double at = scene.depth_m(0, 1) / bin_m;

  const std::vector<MultipathReturn> behind = {{0.5f, 0.3f}, {9.5f, 0.1f}};
  SceneLight points;
  points.returns = behind_every_pixel(scene, behind);
  setup.expect_close(setup.measured(scene, points, 1),
                     {{s, at}, {0.3 * s, at + 0.5 / bin_m}, {0.1 * s, at + 9.5 / bin_m}});

  SceneLight tail;
  tail.tail = ExponentialTail{0.5, 0.4};
  std::vector<Return> trail = {{s, at}};
  constexpr int parts = 2000;
  for (int j = 0; j < parts; ++j)
    trail.push_back({0.4 * s / parts, at - 0.5 * std::log1p(-(j + 0.5) / parts) / bin_m});
  setup.expect_close(setup.measured(scene, tail, 1), trail);

  const Transient transient{{0.0, 3.0, 1.0, 0.5, 0.0, 0.2}, 0.02, -0.03};
  for (const std::size_t count : {std::size_t{1}, scene.depth_m.size()}) {
    SceneLight spread;
    spread.transients.assign(count, transient);
    setup.expect_close(setup.measured(scene, spread, 1), transient.returns(at, s, bin_m));
  }
}

TEST(MultipathCapture, OfDirectLightOnlyIsBitIdentical) {
  const Noiseless setup;
  const SceneImage scene = flat_scene(5);
  const RawFrames direct = capture(scene, setup.code, setup.camera);
  EXPECT_EQ(direct.values, capture(scene, {}, setup.code, setup.camera).values);
  SceneLight nothing_later;
  nothing_later.tail = ExponentialTail{0.5, 0.0};
  EXPECT_EQ(direct.values, capture(scene, nothing_later, setup.code, setup.camera).values);
}

TEST(MultipathCapture, ReportsTheTruthOfEveryReturn) {
  const SceneImage scene = flat_scene(2);
  SceneLight light;
  light.returns = MultipathReturns(1, 2);
  const std::vector<MultipathReturn> two = {{1.5f, 0.5f}, {2.0f, 0.25f}};
  light.returns.append_pixel(two);
  light.returns.append_pixel({});
  const MultipathTruth truth =
      multipath_truth(scene, light, {.signal_e_per_s = 8.0, .falloff = false});
  EXPECT_THAT(truth.first, testing::ElementsAre(0, 2, 2));
  EXPECT_THAT(truth.distance_m, testing::ElementsAre(1.5f, 2.0f));
  EXPECT_THAT(truth.signal_e_per_s, testing::ElementsAre(4.0f, 2.0f));
  EXPECT_EQ(truth.direct_e_per_s(0, 1), 8.0f);
}

TEST(MultipathCapture, RejectsInvalidLight) {
  const Camera camera = two_bucket_camera();
  const SceneImage scene = flat_scene(2);
  const auto refused = [&](const SceneLight& light, const char* what) {
    EXPECT_THAT([&] { light.validate(scene, camera); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(what)));
  };
  const auto behind = [&](std::vector<MultipathReturn> returns) {
    SceneLight light;
    light.returns = behind_every_pixel(scene, returns);
    return light;
  };
  refused(behind({{1.0f, 0.3f}, {0.5f, 0.2f}}), "must be finite and in order");
  refused(behind({{-0.5f, 0.3f}}), "not nearer than the direct return");
  refused(behind({{1.0f, -0.3f}}), "ratio = -0.3");
  refused(behind({{10.5f, 0.3f}}), "less than the unambiguous range");
  SceneLight tail;
  tail.tail = ExponentialTail{12.0, 0.3};
  refused(tail, "at most the unambiguous range");
  const auto transient = [](std::vector<double> bins, double bin_m) {
    SceneLight light;
    light.transients = {{std::move(bins), bin_m}};
    return light;
  };
  refused(transient({1.0, -2.0}, 0.1), "bin 1 = -2");
  refused(transient({1.0, std::numeric_limits<double>::quiet_NaN()}, 0.1), "bin 1 = nan");
  refused(transient({0.0, 0.0}, 0.1), "light of all bins");
  refused(transient({1.0, 1.0, 1.0}, 4.0), "at most the unambiguous range");
}

TEST(MultipathBound, WithoutASecondReturnIsAtLeastThatOfOneAndDecreasesWithDelay) {
  const Camera camera = two_bucket_camera();
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  const MultipathBound bound(model, camera);
  const OperatingPoint point{1e5, 1e4};
  const double one = CramerRaoBound(model, camera).mae_m(point);
  double before = std::numeric_limits<double>::infinity();
  for (const double delay_m : {0.3, 0.5, 0.75, 1.0, 1.5}) {
    const double here = bound.mae_m(bound.sigma_m(point, 0.3, delay_m));
    EXPECT_GT(here, one);
    EXPECT_LT(here, before);
    before = here;
  }
  EXPECT_NEAR(bound.mae_m(bound.sigma_m(point, 0.3, 1.0)), 0.010, 0.004);
}

TEST(MultipathError, TwoReturnsBeatOneWhereTheBoundPredictsIt) {
  MultipathErrorOptions options{
      .delay_m = {1.0}, .ratio = {0.3}, .tail_m = {0.5}, .signal_e_per_s = {1e5}, .trials = 300};
  const Camera camera = two_bucket_camera();
  const CodeSet code = build_family("hamiltonian-k5", camera);
  const MultipathErrorReport report = multipath_error(code, camera, options);
  const MultipathMaps& maps = report.maps.front();
  EXPECT_GT(maps.points.front().gain(), 4.0);
  EXPECT_GT(maps.tails.front().gain(), 4.0);
  EXPECT_LT(maps.points.front().cramer_rao_mae_m, maps.points.front().law_m);
  EXPECT_GT(maps.single.gain(), 0.93);
  EXPECT_LT(maps.single.two_share, 0.03);

  options.delay_m = {0.2};
  const Camera one_tap = built_in_camera("paper-10f0");
  const MultipathErrorReport refused =
      multipath_error(build_family("sinusoid-k4", one_tap), one_tap, options);
  EXPECT_THAT(refused.why_no_two_returns, HasSubstr("independent means"));
  const MultipathCell& cell = refused.maps.front().points.front();
  EXPECT_NEAR(cell.single_bias_m.value, cell.law_m, 0.2 * cell.law_m);
  EXPECT_TRUE(std::isnan(cell.error_m.value));
}

Camera bright_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.taps = 2;
  camera.operating.signal_e_per_s = {1e6};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

TEST(OperatingMultipathError, FollowsTheLawOfCloseReturnsAndTwoReturnDecodingIsBetterFarAway) {
  const Camera camera = bright_camera();
  const CodeSet code = build_family("hamiltonian-k5", camera);
  EvaluateOptions options;
  options.trials = 1000;
  const auto single_path = [&](const OperatingMultipath& later) {
    return operating_multipath_report(code, camera, later, options).single_path.circular_m.value;
  };
  EXPECT_NEAR(single_path({{0.3, 0.3}, {0.15, 0.15}}), single_path_bias_m(0.3, 0.15), 0.005);
  const OperatingMultipath far{{0.3, 0.3}, {1.0, 2.0}};
  const auto report = operating_multipath_report(code, camera, far, options);
  EXPECT_LT(4 * report.two_return->circular_m.value, report.single_path.circular_m.value);
  EXPECT_NEAR(single_path({{0.0, 0.0}, {1.0, 1.0}}),
              evaluate(code, camera, options).circular.geometric_mean_m.value, 0.001);
}

TEST(OperatingMultipathError, IsReportedWithoutTwoReturnsIfTheCodeCannotSeparateThem) {
  const Camera camera = bright_camera();
  EvaluateOptions options;
  options.trials = 200;
  for (const char* name : {"hamiltonian-k5", "sinusoid-k5"}) {
    const CodeSet code = build_family(name, camera);
    const OperatingMultipathReport report = operating_multipath_report(code, camera, {}, options);
    EXPECT_EQ(report.two_return.has_value(), code.name() == "hamiltonian-k5");
  }
}

TEST(OperatingMultipathError, RejectsInvalidSettings) {
  const Camera camera = bright_camera();
  const CodeSet code = build_family("hamiltonian-k5", camera);
  for (const OperatingMultipath& later :
       {OperatingMultipath{.ratio = {-0.1, 0.5}}, OperatingMultipath{.ratio = {0.5, 0.1}},
        OperatingMultipath{.ratio = {0.1, 1.5}}, OperatingMultipath{.delay_m = {0.0, 1.0}},
        OperatingMultipath{.delay_m = {2.0, 1.0}}, OperatingMultipath{.delay_m = {2.0, 11.0}},
        OperatingMultipath{.weight = 1.0}})
    EXPECT_THROW(operating_multipath_report(code, camera, later), std::invalid_argument);
}

TEST(MultipathScene, OfACornerIsBentBySinglePathDecodingAndCoversEveryPixel) {
  const Camera camera = bright_camera();
  const StagedScene corner = built_in_scene("corner", 32, 8);
  const SceneImage image = RayCaster(corner.shapes).see(corner.view).image;
  const MultipathReturns returns = bounced_light(corner, {.rays = 64, .range_m = camera.range_m()});
  const MultipathScene scene =
      multipath_scene("corner", image, corner.view, returns, build_family("hamiltonian-k5", camera),
                      camera, {.signal_e_per_s = 1e6, .reference_distance_m = 2.0});
  std::int64_t pixels = 0;
  for (const DelayClass& its : scene.classes) pixels += its.pixels;
  EXPECT_EQ(pixels, scene.all.pixels);
  EXPECT_EQ(scene.all.pixels, 32 * 8) << "every pixel sees the other wall";
  EXPECT_GT(scene.all.bias_m[0], 0.03) << "light that comes later makes walls look farther";
  EXPECT_LT(std::abs(scene.all.bias_m[1]), scene.all.bias_m[0]);
}

}  // namespace

}  // namespace tofsmith
