// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/capture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "captured_moments.hpp"
#include "generated_shapes.hpp"
#include "rows_setup.hpp"
#include "simulate/pixel_capture.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

Camera noiseless_camera() {
  Camera camera = built_in_camera("paper-10f0");
  camera.sensor.noise = NoiseModel::gaussian;
  camera.sensor.read_noise_e = 0.0;
  camera.exposure_s.total_s = 1e9;  // shot noise far below every tolerance
  return camera;
}

/// Evaluates the error at the centres of the table's cells.
double largest_error(const FineCorrelation& fine, const ForwardModel& model) {
  const Eigen::MatrixXd exact = model.tap_correlation_table(2 * fine.points());
  Eigen::VectorXd chi(fine.tap_values());
  double largest = 0.0;
  for (int cell = 0; cell < fine.points(); ++cell) {
    fine.at((cell + 0.5) / fine.points_per_bin(), chi.data());
    largest = std::max(largest, (chi.transpose() - exact.row(2 * cell + 1)).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(FineCorrelation, StaysWithinItsStatedError) {
  for (const char* name : {"hamiltonian-k5", "multifrequency-k5", "square-k4"}) {
    const Camera camera = built_in_camera("paper-10f0");
    const ForwardModel model(build_family(name, camera), camera);
    const FineCorrelation fine(model);
    const double error = largest_error(fine, model);
    EXPECT_LT(error, 2e-5) << name;
    std::vector<double> chi(static_cast<std::size_t>(fine.tap_values()));
    for (const double z : {0.0, 0.013, 17.77, 239.99, 240.0}) {
      fine.at(z, chi.data());
      const Eigen::VectorXd exact = model.correlation(z);
      for (int i = 0; i < model.measurements(); ++i)
        EXPECT_NEAR(chi[static_cast<std::size_t>(i)], exact[i], 1.01 * error + 1e-12);
    }
  }
}

TEST(FineCorrelation, IsExactWhereCornersFallOnTheTable) {
  const Camera camera = built_in_camera("paper-30x");
  const ForwardModel model(build_family("hamiltonian-k5", camera), camera);
  EXPECT_LT(largest_error(FineCorrelation(model), model), 1e-9);
}

TEST(Capture, SameBitsForAnyNumberOfThreads) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const SceneImage scene = table_top_image(48, 36);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return capture(scene, code, camera, {.frames = 2});
  };
  const RawFrames one = run(1), two = run(2);
  ASSERT_EQ(one.values.size(), 2u * 36 * 48 * 4);
  EXPECT_EQ(std::memcmp(one.values.data(), two.values.data(), one.values.size() * sizeof(float)),
            0);
}

TEST(Capture, FramesAndSeedsDifferAndPixelsAreReproducible) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  SceneImage scene(4, 4);
  const RawFrames a = capture(scene, code, camera, {.seed = 1, .frames = 2});
  const RawFrames b = capture(scene, code, camera, {.seed = 2, .frames = 2});
  EXPECT_NE(a.frame(0)[0], a.frame(1)[0]);
  EXPECT_NE(a.frame(0)[0], b.frame(0)[0]);
  EXPECT_NE(a.frame(0)[0], a.frame(0)[3]);
  const RawFrames first_only = capture(scene, code, camera, {.seed = 1, .frames = 1});
  EXPECT_EQ(std::memcmp(first_only.values.data(), a.frame(0), 4 * 4 * 3 * sizeof(float)), 0);
}

TEST(Capture, HasTheMeanAndCovarianceOfTheModel) {
  for (const NoiseModel noise : {NoiseModel::poisson, NoiseModel::gaussian}) {
    Camera one_tap = built_in_camera("paper-10f0"), rows = rows_camera();
    one_tap.sensor.noise = rows.sensor.noise = noise;
    one_tap.sensor.dark_current_e_per_s = 2e3;
    rows.sensor.dark_current_e_per_s = 30.0;
    rows.sensor.read_noise_e = 60.0;
    Camera two_taps = one_tap;
    two_taps.sensor.taps = 2;
    two_taps.sensor.modulation_contrast = 0.8;
    for (const Camera& camera : {one_tap, two_taps, rows})
      expect_moments_of_the_model(build_family("hamiltonian-k3", camera), camera, {5e3, 2e3}, 17.3);
    Camera dim = one_tap;
    dim.sensor.dark_current_e_per_s = 0.0;
    dim.sensor.read_noise_e = 3.0;
    expect_moments_of_the_model(build_family("hamiltonian-k3", dim), dim, {10.0, 1.0}, 17.3);
  }
}

TEST(Capture, DepthBeyondTheRangeWraps) {
  const Camera camera = noiseless_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  SceneImage scene(1, 2);
  scene.depth_m(0, 0) = 3.0f;
  scene.depth_m(0, 1) = static_cast<float>(3.0 + 2 * camera.range_m());
  const RawFrames raw = capture(scene, code, camera, {.falloff = false});
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(raw.values[k] / raw.values[4 + k], 1.0, 1e-4);
}

TEST(Capture, NoReturnSeesAmbientOnly) {
  const Camera camera = noiseless_camera();
  const CodeSet code = build_family("hamiltonian-k4", camera);
  const RawFrames raw = capture(SceneImage(1, 1), code, camera, {.ambient_e_per_s = 100.0});
  for (const float value : raw.values) EXPECT_NEAR(value / (1e9 / 4 * 100.0 * 0.5), 1.0, 1e-4);
}

TEST(Capture, WithoutFalloffOnlyAlbedoMatters) {
  SceneImage scene(1, 1);
  scene.depth_m(0, 0) = 4.0f;
  scene.albedo(0, 0) = 0.25f;
  scene.cosine(0, 0) = 0.5f;
  EXPECT_DOUBLE_EQ(pixel_signal_e_per_s(scene, 0, 0, {.signal_e_per_s = 100, .falloff = false}),
                   25.0);
  EXPECT_DOUBLE_EQ(
      pixel_signal_e_per_s(scene, 0, 0, {.signal_e_per_s = 100, .reference_distance_m = 2.0}),
      25.0 * 0.5 / 4.0);
}

TEST(Capture, StopsOnRequestAndRejectsInvalidInputs) {
  const Camera camera = built_in_camera("paper-10f0");
  const CodeSet code = build_family("hamiltonian-k3", camera);
  const SceneImage scene(8, 8);
  EXPECT_THROW(capture(scene, code, camera, {}, [](double, std::string_view) { return false; }),
               Interrupted);
  EXPECT_THROW(capture(scene, code, camera, {.frames = 0}), std::invalid_argument);
  EXPECT_THROW(capture(scene, code, camera, {.signal_e_per_s = -1}), std::invalid_argument);
  EXPECT_THROW(capture(SceneImage(), code, camera), std::invalid_argument);
}

TEST(PixelNoise, ConvertsWithGainBlackLevelAndLimits) {
  Sensor sensor;
  sensor.adc_bits = 10;
  sensor.gain_e_per_dn = 2.5;
  sensor.black_level_dn = 64.0;
  const PixelNoise noise(sensor);
  EXPECT_EQ(noise.convert(0.0), 64.0);
  EXPECT_EQ(noise.convert(250.0), 164.0);
  EXPECT_EQ(noise.convert(251.2), 164.0);
  EXPECT_EQ(noise.convert(251.3), 165.0);
  EXPECT_EQ(noise.convert(-100.0), 24.0) << "the black level keeps negative electrons";
  EXPECT_EQ(noise.convert(-1000.0), 0.0);
  EXPECT_EQ(noise.convert(1e6), 1023.0);
}

TEST(PixelNoise, FullWellClipsBeforeConversion) {
  Sensor sensor;
  sensor.full_well_e = 1000.0;
  EXPECT_EQ(PixelNoise(sensor).convert(1500.0), 1000.0);
  EXPECT_EQ(PixelNoise(sensor).convert(-50.0), -50.0);
  sensor.adc_bits = 12;
  sensor.gain_e_per_dn = 1.0;
  EXPECT_EQ(PixelNoise(sensor).convert(1500.0), 1000.0);
}

TEST(PixelNoise, DifferencesUseNeighbouringBuckets) {
  Sensor sensor;
  sensor.taps = 2;
  double raw[] = {7.0, 3.0, 1.0, 5.0};
  PixelNoise(sensor).read_out(raw, 4);
  EXPECT_EQ(raw[1], 3.0);
  sensor.readout = Readout::difference;
  const PixelNoise noise(sensor);
  EXPECT_EQ(noise.measurements(4), 2);
  noise.read_out(raw, 4);
  EXPECT_EQ(raw[0], 4.0);
  EXPECT_EQ(raw[1], -4.0);
}

TEST(PixelNoise, RejectsInvalidSettingsButIgnoresTheGenerator) {
  Sensor sensor;
  sensor.generator = Generator{.edge_grid_s = 1.0 / (7e6 * 12)};  // for a camera of 7 MHz
  EXPECT_NO_THROW(PixelNoise{sensor});
  sensor.full_well_e = -1.0;
  EXPECT_THROW(PixelNoise{sensor}, std::invalid_argument);
}

}  // namespace

}  // namespace tofsmith
