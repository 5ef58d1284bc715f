// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/simulate/capture.hpp"

namespace tofsmith {

/// Captures equal pixels at `depth_bin` and compares their mean and covariance with the forward
/// model. The scene gives 1.6 times the signal and three times the ambient light.
inline void expect_moments_of_the_model(const CodeSet& code, const Camera& camera,
                                        const OperatingPoint& light, double depth_bin) {
  constexpr int pixels = 10000;
  const auto depth_m = static_cast<float>(depth_bin * camera.bin_m());
  SceneImage scene(1, pixels);
  scene.depth_m = Image<float>(1, pixels, depth_m);
  scene.albedo = Image<float>(1, pixels, 0.5f);
  scene.cosine = Image<float>(1, pixels, 0.8f);
  scene.ambient_scale = Image<float>(1, pixels, 3.0f);
  const RawFrames raw = capture(scene, code, camera,
                                {.signal_e_per_s = light.signal_e_per_s,
                                 .ambient_e_per_s = light.ambient_e_per_s,
                                 .reference_distance_m = 2.0 * depth_m});
  const Eigen::Map<const Eigen::MatrixXf> values(raw.values.data(), raw.measurements, pixels);
  const Eigen::MatrixXd y = values.cast<double>();
  const Eigen::VectorXd mean = y.rowwise().mean();
  const Eigen::MatrixXd residual = y.colwise() - mean;
  const Eigen::MatrixXd covariance = residual * residual.transpose() / pixels;
  const ForwardModel model(code, camera);
  const Return seen{1.6 * light.signal_e_per_s, depth_m / camera.bin_m()};
  const double ambient_e_per_s = 3.0 * light.ambient_e_per_s;
  const Eigen::VectorXd expected = model.expected_electrons({&seen, 1}, ambient_e_per_s);
  const Eigen::MatrixXd expected_e2 = model.covariance_e2({&seen, 1}, ambient_e_per_s);
  ASSERT_EQ(raw.measurements, model.measurements());
  for (int i = 0; i < raw.measurements; ++i) {
    EXPECT_NEAR(mean[i], expected[i], 4 * std::sqrt(expected_e2(i, i) / pixels));
    for (int j = 0; j <= i; ++j)
      EXPECT_NEAR(
          covariance(i, j), expected_e2(i, j),
          4 * std::sqrt((expected_e2(i, i) * expected_e2(j, j) + std::pow(expected_e2(i, j), 2)) /
                        pixels));
  }
}

}  // namespace tofsmith
