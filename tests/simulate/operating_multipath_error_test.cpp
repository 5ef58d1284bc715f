// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/depth_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith {
namespace {

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
