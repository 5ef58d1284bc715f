// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "refusal.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {
namespace {

Camera small_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = 48;
  camera.exposure_s.each_s = {0.1, 0.1, 0.1};
  camera.operating.signal_e_per_s = {3e4};
  camera.operating.ambient_e_per_s = {1e4};
  camera.operating.error = DepthErrorKind::circular;
  return camera;
}

RequirementOptions quick(double error_m) {
  return {.error_m = error_m,
          .max_factor = 16.0,
          .exact = true,
          .effort = 0.01,
          .trials = 1000,
          .map = false};
}

double error_of(const CodeSet& code, const Camera& camera, const RequirementOptions& options) {
  const EvaluateOptions judging{.trials = options.trials, .seed = options.seed + 2};
  return geometric_mean_error_m(evaluate(code, camera, judging), DepthErrorKind::circular);
}

TEST(Requirements, TheResultSufficesAndLessDoesNot) {
  const Camera camera = small_camera();
  RequirementOptions options = quick(0.0);
  for (const double error_m : {0.01, 0.1}) {  // above and below its present error
    options.error_m = error_m;
    options.vary_bandwidth = options.vary_exposure = error_m == 0.01;
    const Requirements found = find_requirements(camera, options);
    ASSERT_EQ(found.varied.size(), error_m == 0.01 ? 3u : 1u);
    EXPECT_EQ(found.error_m < error_m, error_m == 0.1);
    for (const Sufficiency& s : found.varied) {
      EXPECT_LE(s.excluded_below, s.factor.value_or(16.0));
      if (!s.factor) {
        EXPECT_EQ(s.quantity, CameraQuantity::bandwidth) << "light alone suffices";
        EXPECT_GT(s.error_m, error_m);
        continue;
      }
      EXPECT_EQ(*s.factor < 1.0, error_m == 0.1) << name_of(s.quantity);
      EXPECT_LE(s.error_m, error_m);
      EXPECT_EQ(s.error_m, error_of(s.code, with_scaled(camera, s.quantity, *s.factor), options));
      EXPECT_GT(error_of(s.code, with_scaled(camera, s.quantity, 0.98 * *s.factor), options),
                error_m);
    }
  }
}

TEST(Requirements, CodesOfTheAtlasReachTheErrorWithAtLeastTheExactAmount) {
  const Camera camera = small_camera();
  RequirementOptions options = quick(0.02);
  options.vary_exposure = false;
  const Requirements exact = find_requirements(camera, options);
  options.exact = false;
  const Requirements fast = find_requirements(camera, options);
  constexpr double sampling = 0.97;  // few trials choose the exact codes
  for (std::size_t i = 0; i < exact.varied.size(); ++i) {
    const Sufficiency& s = fast.varied[i];
    if (!s.factor) continue;  // only a designed code may suffice
    ASSERT_TRUE(exact.varied[i].factor) << name_of(s.quantity);
    EXPECT_GE(*s.factor, sampling * *exact.varied[i].factor) << name_of(s.quantity);
    EXPECT_GE(*s.factor, s.excluded_below);
    EXPECT_LE(error_of(s.code, with_scaled(camera, s.quantity, *s.factor), options), 0.02);
  }
  EXPECT_TRUE(fast.varied.back().factor) << "more power always suffices";
}

TEST(Requirements, PowerEqualsExposureIfOnlyTheSignalHasNoise) {
  Camera camera = small_camera();
  camera.sensor.read_noise_e = 0.0;
  camera.operating.ambient_e_per_s = {0.0};
  RequirementOptions options = quick(0.008);
  options.vary_bandwidth = false;
  const Requirements found = find_requirements(camera, options);
  EXPECT_NEAR(*found.varied[0].factor / *found.varied[1].factor, 1.0, 0.02);
}

TEST(Requirements, UnreachableErrorsAreReportedReproducibly) {
  RequirementOptions options = quick(1e-4);
  options.max_factor = 1.5;
  options.vary_bandwidth = options.vary_exposure = false;
  const Requirements found = find_requirements(small_camera(), options);
  ASSERT_EQ(found.varied.size(), 1u);
  EXPECT_FALSE(found.varied[0].factor.has_value());
  EXPECT_GT(found.varied[0].error_m, 1e-4);
  EXPECT_EQ(found.varied[0].excluded_below, 1.5);
  EXPECT_EQ(found.varied[0].error_m, find_requirements(small_camera(), options).varied[0].error_m);
}

TEST(Requirements, TheMapDecreasesWithBandwidthAndPower) {
  RequirementOptions options = quick(0.02);
  options.max_factor = 4.0;
  options.exact = false;
  options.vary_exposure = false;
  options.map = true;
  const Requirements found = find_requirements(small_camera(), options);
  ASSERT_TRUE(found.map.has_value());
  const Eigen::MatrixXd& error_m = found.map->error_m;
  ASSERT_EQ(error_m.rows(), std::ssize(found.map->bandwidth));
  ASSERT_EQ(error_m.cols(), std::ssize(found.map->power));
  for (Eigen::Index b = 0; b < error_m.rows(); ++b)
    for (Eigen::Index p = 1; p < error_m.cols(); ++p)
      EXPECT_LT(error_m(b, p), 1.02 * error_m(b, p - 1));
  EXPECT_LT(error_m(error_m.rows() - 1, error_m.cols() - 1), 0.5 * error_m(0, 0));
}

TEST(ScaledCamera, IncreasesOneQuantity) {
  const Camera camera = built_in_camera("paper-10f0");
  const Camera wider = with_scaled(camera, CameraQuantity::bandwidth, 2.0);
  EXPECT_NEAR(std::abs(wider.transfer(8)[8] - camera.transfer(4)[4]), 0.0, 1e-12);
  EXPECT_EQ(with_scaled(camera, CameraQuantity::power, 3.0).operating.middle().signal_e_per_s,
            3.0 * camera.operating.middle().signal_e_per_s);
  EXPECT_EQ(with_scaled(camera, CameraQuantity::exposure, 0.5).exposure_s.of(0, 3),
            0.5 * camera.exposure_s.of(0, 3));
}

TEST(Requirements, RejectsInvalidRequests) {
  const Camera camera = small_camera();
  EXPECT_THROW(find_requirements(camera, quick(0.0)), InvalidArgument);
  EXPECT_THROW(with_scaled(camera, CameraQuantity::power, -1.0), InvalidArgument);
  RequirementOptions nothing = quick(0.01);
  nothing.vary_bandwidth = nothing.vary_power = nothing.vary_exposure = false;
  EXPECT_THROW(find_requirements(camera, nothing), InvalidArgument);
  Camera unlimited = camera;
  unlimited.light.impulse_response = unlimited.sensor.impulse_response = {};
  unlimited.sensor.shortest_pulse_s = 2e-9;
  EXPECT_THAT(refusal_of([&] { find_requirements(unlimited, quick(0.01)); }),
              testing::HasSubstr("impulse_response = none; must be set for at least one arm"));
}

}  // namespace
}  // namespace tofsmith
