// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/exposure_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "design/exposure_shares.hpp"
#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/simulate/bounds.hpp"

namespace tofsmith {
namespace {

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

}  // namespace
}  // namespace tofsmith
