// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/shared/random.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {
namespace {

using std::numbers::pi;

Camera camera_with_jitter(double light_s, double sensor_s) {
  Camera camera = built_in_camera("paper-30x");
  camera.samples = 60;
  camera.light.edge_jitter_s = light_s;
  camera.sensor.edge_jitter_s = sensor_s;
  return camera;
}

TEST(EdgeJitter, AttenuatesEveryHarmonicInClosedForm) {
  for (const char* name : {"paper-30x", "paper-10f0"}) {
    Camera camera = built_in_camera(name);
    const Eigen::VectorXcd plain = camera.transfer(40);
    camera.light.edge_jitter_s = 80e-12;
    camera.sensor.edge_jitter_s = 50e-12;
    const Eigen::VectorXcd blurred = camera.transfer(40);
    for (int n = 0; n <= 40; ++n) {
      const double w = 2 * pi * n * 15e6;
      const double blur = std::exp(-w * w * (80e-12 * 80e-12 + 50e-12 * 50e-12) / 2);
      EXPECT_NEAR(std::abs(blurred[n] - blur * plain[n]), 0.0, 1e-14) << name << " " << n;
    }
  }
}

TEST(EdgeJitter, EqualsTheMeanOverDisplacedEdges) {
  // Correlates a pulse with a gate whose edges are displaced independently in each period.
  const Camera camera = camera_with_jitter(1e-9, 0.5e-9);
  const double f0 = camera.fundamental_frequency_hz;
  const CodeSet code =
      CodeSet::create("one", 60, 1, {3, rectangular_pulse(0.2, 0.1)}, {3, square_wave(1, 0.2)});
  const ForwardModel model(code, camera);
  ForwardModel still(code, camera_with_jitter(0.0, 0.0));
  RandomStream random(4, 0);
  constexpr int periods = 3000;
  for (const double depth_bin : {6.0, 11.3, 40.0}) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < periods; ++i) {
      const auto moved = [&](double edge, double rms_s) {
        return edge + rms_s * f0 * random.normal();
      };
      const Waveform light = Waveform::binary({{moved(0.1, 1e-9), moved(0.3, 1e-9)}}, 5.0);
      const Waveform gate = Waveform::binary({{moved(0.2, 0.5e-9), moved(0.7, 0.5e-9)}});
      const double chi = CorrelationFunction(gate, light)(depth_bin / 60);
      sum += chi;
      squares += chi * chi;
    }
    const double mean = sum / periods;
    const double se = std::sqrt((squares / periods - mean * mean) / periods);
    EXPECT_NEAR(model.correlation(depth_bin)[0], mean, 4 * se + 1e-6) << depth_bin;
  }
  EXPECT_GT(std::abs(model.correlation(6.0)[0] - still.correlation(6.0)[0]), 1e-4);
}

TEST(EdgeJitter, OfZeroChangesNothing) {
  Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const Eigen::MatrixXd table = ForwardModel(code, camera).correlation_table(100);
  camera.sensor.edge_jitter_s = 0.0;
  camera.sensor.tap_mismatch = 0.0;
  EXPECT_EQ(ForwardModel(code, camera).correlation_table(100), table);
  EXPECT_FALSE(built_in_camera("paper-30x").band_limited());
  EXPECT_TRUE(camera_with_jitter(0.0, 1e-12).band_limited());
  EXPECT_FALSE(camera_with_jitter(0.0, 1e-12).light_is_band_limited());
}

TEST(TapMismatch, ScalesSignalAndAmbientOfNeighbours) {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.dark_current_e_per_s = 100.0;
  for (const int taps : {1, 2}) {
    camera.sensor.taps = taps;
    camera.sensor.tap_mismatch = 0.0;
    const CodeSet code = build_family("hamiltonian-k3", camera);
    const ForwardModel even(code, camera);
    camera.sensor.tap_mismatch = 0.02;
    const ForwardModel uneven(code, camera);
    for (int i = 0; i < code.measurements(); ++i) {
      const double gain = i % 2 == 0 ? 1.01 : 0.99;
      EXPECT_NEAR(uneven.correlation(17.3)[i], gain * even.correlation(17.3)[i], 1e-15);
      EXPECT_NEAR(uneven.correlation_table(30)(7, i), gain * even.correlation_table(30)(7, i),
                  1e-15);
      EXPECT_NEAR(uneven.ambient_gain()[i], gain * even.ambient_gain()[i], 1e-15);
    }
    EXPECT_EQ(uneven.dark_electrons(), even.dark_electrons());
  }
}

TEST(ImperfectArms, RejectInvalidValues) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.edge_jitter_s = -1e-12;
  EXPECT_THROW(camera.validate(), std::invalid_argument);
  camera.light.edge_jitter_s = NAN;
  EXPECT_THROW(camera.validate(), std::invalid_argument);
  camera.light.edge_jitter_s = 0.0;
  for (const double mismatch : {-1.0, 1.0, static_cast<double>(NAN)}) {
    camera.sensor.tap_mismatch = mismatch;
    EXPECT_THROW(camera.validate(), std::invalid_argument);
  }
}

}  // namespace
}  // namespace tofsmith
