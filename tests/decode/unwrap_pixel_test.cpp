// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the unwrapping decoder says of a pixel besides its depth.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tofsmith/core/parallel.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decode_method.hpp"
#include "unwrap_setup.hpp"

namespace tofsmith {
namespace {

DepthImage decode_pixels(const UnwrapDecoder& decoder, const std::vector<float>& raw) {
  return decoder.decode(frame_of(raw, decoder.measurements()));
}

TEST(UnwrapDecoder, StrongSignalIsOk) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e6, 30.0, 1e3);
  const DepthImage image = decode_pixels(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::ok);
  EXPECT_NEAR(image.depth_m(0, 0), setup.camera.range_m() / 8, 1e-3);
  EXPECT_NEAR(image.signal_e_per_s(0, 0), 1e6, 2e3);
  EXPECT_NEAR(image.ambient_e_per_s(0, 0), 1e3, 1e3);
  EXPECT_GT(image.confidence(0, 0), 0.999);
}

TEST(UnwrapDecoder, NotANumberIsInvalidAndDisturbsNoNeighbour) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, 20, 1);
  const DepthImage before = decode_pixels(setup.decoder, raw);
  raw[5 * 10 + 2] = std::numeric_limits<float>::quiet_NaN();
  raw[5 * 11] = std::numeric_limits<float>::infinity();
  const DepthImage after = decode_pixels(setup.decoder, raw);
  const auto positions = depth_bins_of(setup.decoder, raw);
  std::vector<std::int32_t> bins(20);
  setup.decoder.decode_bins(raw.data(), 20, bins.data());
  for (std::size_t i = 0; i < 20; ++i) {
    if (i == 10 || i == 11) {
      EXPECT_EQ(after.status.pixels[i], PixelStatus::invalid);
      EXPECT_TRUE(std::isnan(after.depth_m.pixels[i]));
      EXPECT_TRUE(std::isnan(positions[i]));
      EXPECT_EQ(bins[i], -1);
    } else {
      EXPECT_EQ(after.status.pixels[i], before.status.pixels[i]);
      EXPECT_EQ(after.depth_m.pixels[i], before.depth_m.pixels[i]);
      EXPECT_LE(std::abs(circular_difference(bins[i], positions[i], 240)), 0.5);
      EXPECT_LT(bins[i], 240);
    }
  }
}

TEST(UnwrapDecoder, StatusFollowsTheSameRulesAsZncc) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const UnwrapSetup setup("multifrequency-k5", camera);
  EXPECT_EQ(decode_pixels(setup.decoder, std::vector<float>(5, 700.0f)).status(0, 0),
            PixelStatus::no_return);
  EXPECT_EQ(decode_pixels(setup.decoder, std::vector<float>(5, 5000.0f)).status(0, 0),
            PixelStatus::saturated);
  std::vector<float> faint;
  setup.append_expected(faint, 50.0, 30.0, 1e4);
  EXPECT_EQ(decode_pixels(setup.decoder, faint).status(0, 0), PixelStatus::low_signal);
  RawFrames wrong = frame_of(std::vector<float>(8, 1.0f), 4);
  EXPECT_THROW(setup.decoder.decode(wrong), std::invalid_argument);
}

struct NoiseCase {
  const char* code;
  const char* camera;
  int taps;
  Readout readout;
  UnwrapWeights weights;
};

class UnwrapEstimatesOf : public testing::TestWithParam<NoiseCase> {};

TEST_P(UnwrapEstimatesOf, AgreeWithMonteCarloAtHighSignal) {
  const NoiseCase c = GetParam();
  const UnwrapSetup setup(c.code, camera_with(c.camera, c.taps, c.readout), {.weights = c.weights});
  const int k_count = setup.decoder.measurements(), trials = 4000;
  for (const double truth_bin : {33.3, 121.7, 200.2}) {
    const Return r{1e6, truth_bin};
    const Eigen::VectorXd mean = setup.model.expected_electrons({&r, 1}, 1e4);
    const Eigen::VectorXd variance = setup.model.variance_e2({&r, 1}, 1e4);
    RandomStream random(3, static_cast<std::uint64_t>(truth_bin));
    std::vector<float> raw;
    for (int i = 0; i < trials; ++i)
      for (int k = 0; k < k_count; ++k)
        raw.push_back(static_cast<float>(mean[k] + std::sqrt(variance[k]) * random.normal()));
    const DepthImage image = decode_pixels(setup.decoder, raw);
    RunningStatistics depth_m, predicted_m;
    for (int i = 0; i < trials; ++i) {
      depth_m.add(image.depth_m(0, i));
      predicted_m.add(image.predicted_standard_deviation_m(0, i));
    }
    EXPECT_NEAR(predicted_m.mean() / std::sqrt(depth_m.variance()), 1.0, 0.06)
        << c.code << " at " << truth_bin;
  }
}

INSTANTIATE_TEST_SUITE_P(Codes, UnwrapEstimatesOf,
                         testing::Values(NoiseCase{"sinusoid-k4", "paper-10f0", 1,
                                                   Readout::separate, UnwrapWeights::variance},
                                         NoiseCase{"multifrequency-k5", "paper-30x", 1,
                                                   Readout::separate, UnwrapWeights::variance},
                                         NoiseCase{"multifrequency-k5", "paper-10f0", 1,
                                                   Readout::separate, UnwrapWeights::frequency},
                                         NoiseCase{"multifrequency-1x4-7x4", "paper-10f0", 2,
                                                   Readout::separate, UnwrapWeights::variance},
                                         NoiseCase{"multifrequency-1x3-5x3", "paper-10f0", 2,
                                                   Readout::difference, UnwrapWeights::variance}));

TEST(UnwrapDecoder, ConfidentPixelsAreRightAsOftenAsTheySay) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-30x"));
  const int pixels = 20000;
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 3e4, pixels, 11);
  const DepthImage image = decode_pixels(setup.decoder, raw);
  RandomStream random(11, 0);
  int sure = 0, sure_wrong = 0, unsure = 0, unsure_wrong = 0;
  const double far_m = setup.camera.range_m() / 14;
  for (int i = 0; i < pixels; ++i) {
    const double truth_m = random.uniform() * setup.camera.range_m();
    for (int k = 0; k < 5; ++k) random.normal();
    const double error_m = std::abs(circular_difference(static_cast<double>(image.depth_m(0, i)),
                                                        truth_m, setup.camera.range_m()));
    const float confidence = image.confidence(0, i);
    if (confidence > 0.95f) ++sure, sure_wrong += error_m > far_m;
    if (confidence < 0.8f) ++unsure, unsure_wrong += error_m > far_m;
  }
  EXPECT_GT(sure, 1000);
  EXPECT_GT(unsure, 1000);
  EXPECT_LE(sure_wrong, 0.02 * sure);
  EXPECT_GE(unsure_wrong, 0.15 * unsure);
}

TEST(UnwrapDecoder, GivesTheSameBitsOnAnyNumberOfThreads) {
  const UnwrapSetup setup("multifrequency-k5", camera_with("paper-10f0"));
  const RawFrames frame = frame_of(noisy_pixels(setup.decoder.table(), 3e3, 1e4, 10007, 5), 5);
  const auto depths_on = [&](int threads) {
    const ThreadLimit limit(threads);
    return setup.decoder.decode(frame).depth_m.pixels;
  };
  const std::vector<float> one = depths_on(1), many = depths_on(4);
  EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(float)), 0);
}

TEST(DecodeMethod, HasAName) {
  for (const DecodeMethod method : all_decode_methods)
    EXPECT_EQ(parse_decode_method(name_of(method)), method);
  for (const UnwrapWeights weights : {UnwrapWeights::variance, UnwrapWeights::frequency})
    EXPECT_EQ(parse_unwrap_weights(name_of(weights)), weights);
  EXPECT_THROW(parse_decode_method("magic"), std::invalid_argument);
  EXPECT_THROW(parse_unwrap_weights("magic"), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
