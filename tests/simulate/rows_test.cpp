// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rows_setup.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

TEST(RowsCapture, HasTheMeanAndCovarianceOfTheModel) {
  for (const NoiseModel noise : {NoiseModel::poisson, NoiseModel::gaussian}) {
    Camera camera = rows_camera();
    camera.sensor.noise = noise;
    camera.sensor.read_noise_e = 4.0;
    camera.sensor.dark_current_e_per_s = 30.0;
    const CodeSet code = build_family("hamiltonian-k3", camera);
    const ForwardModel model(code, camera);
    constexpr int pixels = 6000;
    SceneImage scene(1, pixels);
    const double depth_m = 17.3 * camera.bin_m();
    std::fill(scene.depth_m.pixels.begin(), scene.depth_m.pixels.end(),
              static_cast<float>(depth_m));
    const RawFrames raw = capture(
        scene, code, camera, {.signal_e_per_s = 500, .ambient_e_per_s = 200, .falloff = false});
    const Eigen::Map<const Eigen::MatrixXf> values(raw.values.data(), 3, pixels);
    const Eigen::MatrixXd y = values.cast<double>();
    const Eigen::VectorXd mean = y.rowwise().mean();
    const Eigen::MatrixXd residual = y.colwise() - mean;
    const Eigen::MatrixXd covariance = residual * residual.transpose() / pixels;
    const Return seen{500, depth_m / camera.bin_m()};
    const Eigen::VectorXd expected = model.expected_electrons({&seen, 1}, 200);
    const Eigen::MatrixXd expected_e2 = model.covariance_e2({&seen, 1}, 200);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(mean[i], expected[i], 4 * std::sqrt(expected_e2(i, i) / pixels));
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(
            covariance(i, j), expected_e2(i, j),
            4 * std::sqrt((expected_e2(i, i) * expected_e2(j, j) + std::pow(expected_e2(i, j), 2)) /
                          pixels));
    }
  }
}

TEST(RowsBounds, CramerRaoIsTheInverseOfTheFisherMatrixOfCorrelatedNoise) {
  Camera camera = rows_camera();
  camera.sensor.read_noise_e = 2.0;
  const ForwardModel model(build_family("histogram-k6", camera), camera);
  const OperatingPoint point{2e3, 5e2};
  const Eigen::VectorXd sigma_m = CramerRaoBound(model, camera).sigma_m(point);
  for (int j = 3; j < 240; j += 29) {
    const double z = (j + 0.5) / 4, h = 1e-3;
    const Return seen{point.signal_e_per_s, z};
    Eigen::MatrixXd jacobian(6, 3);
    jacobian << point.signal_e_per_s * (model.correlation(z + h) - model.correlation(z - h)) /
                    (2 * h),
        model.correlation(z), model.ambient_gain();
    const Eigen::Matrix3d fisher =
        jacobian.transpose() * model.covariance_e2({&seen, 1}, 5e2).inverse() * jacobian;
    EXPECT_NEAR(sigma_m[j], std::sqrt(fisher.inverse()(0, 0)) * camera.bin_m(), 5e-3 * sigma_m[j]);
  }
}

TEST(RowsBounds, ARowForEveryBinUsesTheWholeHistogram) {
  const Camera camera = rows_camera(16);
  const CodeSet pulse = build_family("histogram-k4", camera);
  const CodeSet all =
      CodeSet::create_rows("all", pulse.modulation(0), Eigen::MatrixXd::Identity(16, 16));
  const Eigen::MatrixXd mix = Eigen::MatrixXd::Random(16, 16);
  const CodeSet mixed = CodeSet::create_rows("mixed", pulse.modulation(0), mix);
  const HistogramBound bound(ForwardModel(all, camera), camera);
  for (const OperatingPoint point : {OperatingPoint{1e3, 1e2}, OperatingPoint{1e3, 1e4}}) {
    const double expected_m = bound.mae_m(point);
    for (const CodeSet& code : {all, mixed})
      EXPECT_NEAR(CramerRaoBound(ForwardModel(code, camera), camera).mae_m(point), expected_m,
                  1e-5 * expected_m);
    EXPECT_GT(CramerRaoBound(ForwardModel(pulse, camera), camera).mae_m(point), expected_m);
  }
}

TEST(RowsBounds, NoRowsBeatThePhotonsOfTheReceiver) {
  const Camera camera = rows_camera();
  const ReceiverBound receiver(camera, 1);
  for (const char* name : {"fourier-k8", "hamiltonian-k4", "histogram-k6"}) {
    const ForwardModel model(build_family(name, camera), camera);
    for (const OperatingPoint point : {OperatingPoint{1e2, 1e2}, OperatingPoint{1e4, 1e2}}) {
      const double histogram_m = HistogramBound(model, camera).mae_m(point);
      EXPECT_LE(receiver.mae_m(point), histogram_m) << name;
      EXPECT_LE(histogram_m, CramerRaoBound(model, camera).mae_m(point) * 1.0001) << name;
    }
  }
}

TEST(RowsError, BothDecodersReachTheBoundInBrightLight) {
  for (const NoiseModel noise : {NoiseModel::poisson, NoiseModel::gaussian})
    for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml}) {
      Camera camera = rows_camera(60, 2e4, 1e4);
      camera.sensor.noise = noise;
      const CodeSet code = build_family("fourier-k6", camera);
      const DepthErrorReport report =
          evaluate(code, camera, {.trials = 2000, .seed = 3, .method = method});
      const PointDepthError& error = report.points.front();
      EXPECT_NEAR(error.circular_mde_m.value / error.cramer_rao_mae_m, 1.0,
                  method == DecodeMethod::ml ? 0.06 : 0.15)
          << name_of(method);
    }
}

TEST(RowsError, PoissonAndNormalNoiseHaveEqualErrorsInBrightLight) {
  Camera camera = rows_camera(60, 1e3, 5e3);
  camera.sensor.read_noise_e = 5.0;
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const Estimate poisson = evaluate(code, camera, {.trials = 4000}).circular.geometric_mean_m;
  camera.sensor.noise = NoiseModel::gaussian;
  const Estimate normal = evaluate(code, camera, {.trials = 4000}).circular.geometric_mean_m;
  EXPECT_NEAR(poisson.value, normal.value,
              4 * std::hypot(poisson.standard_error, normal.standard_error));
}

TEST(RowsError, AnyInvertibleMixtureOfRowsHasTheSameErrorWithMl) {
  // Whitening makes them equivalent.
  const Camera camera = rows_camera(60, 1e3, 5e2);
  const CodeSet code = build_family("fourier-k4", camera);
  Eigen::Matrix4d mix;
  mix << 2, 1, 0, 0, 0, 1, -3, 0, 0, 0, 1, 5, 0.5, 0, 0, 1;
  const CodeSet mixed =
      CodeSet::create_rows("mixed", code.modulation(0), code.demodulation_samples() * mix);
  for (const DecodeMethod method : {DecodeMethod::zncc, DecodeMethod::ml}) {
    const EvaluateOptions options{.trials = 1000, .method = method};
    const double expected_m = evaluate(code, camera, options).circular.geometric_mean_m.value;
    EXPECT_NEAR(evaluate(mixed, camera, options).circular.geometric_mean_m.value, expected_m,
                2e-3 * expected_m);
  }
}

}  // namespace
}  // namespace tofsmith
