// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/robustness.hpp"

#include <gtest/gtest.h>

namespace tofsmith {
namespace {

Camera small_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.operating.signal_e_per_s = {1e5};
  camera.operating.ambient_e_per_s = {1e3};
  return camera;
}

TEST(GeneratorLoss, IsZeroIfTheGeneratorReproducesTheCodeExactly) {
  Camera camera = small_camera();
  const CodeSet code = build_family("hamiltonian-k3", camera);
  camera.light.generator = camera.sensor.generator = Generator{.sample_rate_hz = 60 * 15e6};
  const GeneratorLoss loss = generator_loss(code, camera, {.trials = 400});
  EXPECT_NEAR(loss.ratio(DepthErrorKind::linear), 1.0, 1e-6);
  EXPECT_NEAR(loss.uncalibrated_ratio(DepthErrorKind::linear), 1.0, 1e-6);
  ASSERT_EQ(loss.correlation_change.size(), 3u);
  for (const double change : loss.correlation_change) EXPECT_LT(change, 1e-9);
}

TEST(GeneratorLoss, OfFewPointsEqualsThatOfEvaluateWithTheSameTrials) {
  Camera camera = small_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const EvaluateOptions options{.trials = 1000, .seed = 7};
  const double nominal_m = evaluate(code, camera, options).linear.geometric_mean_m.value;
  camera.light.generator = camera.sensor.generator = Generator{.sample_rate_hz = 16 * 15e6};
  const GeneratorLoss loss = generator_loss(code, camera, options);
  EXPECT_EQ(loss.nominal.linear.geometric_mean_m.value, nominal_m);
  EXPECT_EQ(loss.actual.linear.geometric_mean_m.value,
            evaluate(code, camera, options).linear.geometric_mean_m.value);
  EXPECT_GT(loss.uncalibrated_ratio(DepthErrorKind::linear), 1.05);
  EXPECT_GT(loss.uncalibrated_ratio(DepthErrorKind::linear), loss.ratio(DepthErrorKind::linear));
  for (const double change : loss.correlation_change) EXPECT_GT(change, 0.01);
}

}  // namespace
}  // namespace tofsmith
