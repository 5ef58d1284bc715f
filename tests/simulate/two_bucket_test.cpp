// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/shared/random.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {
namespace {

Camera two_bucket_camera(int samples = 240) {
  Camera camera = built_in_camera("paper-10f0");
  camera.samples = samples;
  camera.sensor.taps = 2;
  return camera;
}

SceneImage random_depths(int height, int width, double range_m) {
  SceneImage scene(height, width);
  RandomStream random(4, 0);
  for (float& depth_m : scene.depth_m.pixels)
    depth_m = static_cast<float>(range_m * random.uniform());
  return scene;
}

TEST(TwoBuckets, CapturedPairsContainAllLightAndTwoReadNoises) {
  for (const NoiseModel noise : {NoiseModel::poisson, NoiseModel::gaussian}) {
    Camera camera = two_bucket_camera();
    camera.sensor.noise = noise;
    camera.sensor.modulation_contrast = 0.8;
    camera.sensor.dark_current_e_per_s = 500.0;
    const CodeSet code = build_family("hamiltonian-k4", camera);
    const double S = 2e4, A = 5e3, T = camera.exposure_s.total_s / 4;
    const RawFrames raw = capture(random_depths(40, 50, camera.range_m()), code, camera,
                                  {.signal_e_per_s = S, .ambient_e_per_s = A, .falloff = false});
    ASSERT_EQ(raw.measurements, 8);
    RunningStatistics sums;
    for (std::size_t i = 0; i < raw.values.size(); i += 2)
      sums.add(static_cast<double>(raw.values[i]) + raw.values[i + 1]);
    const double all_e = T * (S + A + 2 * 500.0), variance_e2 = all_e + 2 * 400.0;
    EXPECT_NEAR(sums.mean(), all_e, 4 * sums.standard_error());
    const double count = static_cast<double>(sums.count());
    EXPECT_NEAR(sums.variance() / variance_e2, 1.0, 4 * std::sqrt(2 / count));
  }
}

struct TwoBucketCode {
  const char* name;
  int samples;
};

constexpr TwoBucketCode two_bucket_codes[] = {
    {"hamiltonian-k4", 240},          {"hamiltonian-k5", 240},
    {"hamiltonian-k6", 240},          {"hamiltonian-k7", 252},
    {"hamiltonian-k8", 252},          {"sinusoid-k4", 240},
    {"multifrequency-1x4-7x4", 240},  {"multifrequency-1x2-7x2", 240},
    {"pulsed-multifrequency-k4", 240}};

TEST(TwoBuckets, CapturedDepthsAreDecoded) {
  for (const TwoBucketCode& c : two_bucket_codes)
    for (const Readout readout : {Readout::separate, Readout::difference}) {
      Camera camera = two_bucket_camera(c.samples);
      camera.sensor.readout = readout;
      camera.exposure_s.total_s = 3000.0;  // almost no noise
      const CodeSet code = build_family(c.name, camera);
      const SceneImage scene = random_depths(20, 30, camera.range_m());
      const RawFrames raw = capture(scene, code, camera, {.falloff = false});
      const Decoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
      const DepthImage image = decoder.decode(raw);
      for (std::size_t i = 0; i < scene.depth_m.size(); ++i)
        ASSERT_LT(std::abs(circular_difference(image.depth_m.pixels[i], scene.depth_m.pixels[i],
                                               camera.range_m())),
                  0.02)
            << c.name;
    }
}

TEST(TwoBuckets, TheSecondBucketReducesTheError) {
  for (const TwoBucketCode& c : two_bucket_codes) {
    Camera camera = two_bucket_camera(c.samples);
    camera.operating.signal_e_per_s = {1e5};
    camera.operating.ambient_e_per_s = {1e4};
    const DepthErrorReport two = evaluate(build_family(c.name, camera), camera, {.trials = 4000});
    EXPECT_EQ(two.taps, 2);
    EXPECT_EQ(two.measurements, 2 * two.exposures);
    camera.sensor.taps = 1;
    const DepthErrorReport one = evaluate(build_family(c.name, camera), camera, {.trials = 4000});
    EXPECT_EQ(one.exposures, two.exposures);
    EXPECT_LT(two.circular.mean_m.value, 0.9 * one.circular.mean_m.value) << c.name;
    EXPECT_GT(two.circular.mean_m.value, two.points[0].receiver_bound_mae_m) << c.name;
  }
}

}  // namespace
}  // namespace tofsmith
