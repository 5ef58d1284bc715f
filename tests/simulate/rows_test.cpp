// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "rows_setup.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

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
