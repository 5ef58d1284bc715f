// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What the decoder by maximum likelihood says of a pixel besides its depth.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "likelihood_setup.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

DepthImage decode_pixels(const LikelihoodDecoder& decoder, const std::vector<float>& raw) {
  return decoder.decode(frame_of(raw, decoder.measurements()));
}

TEST(LikelihoodDecoder, StrongSignalIsOk) {
  const LikelihoodSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e5, 30.0, 1e3);
  const DepthImage image = decode_pixels(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::ok);
  EXPECT_NEAR(image.depth_m(0, 0), setup.camera.range_m() / 8, 1e-3);
  EXPECT_NEAR(image.signal_e_per_s(0, 0), 1e5, 100.0);
  EXPECT_NEAR(image.ambient_e_per_s(0, 0), 1e3, 100.0);
  EXPECT_GT(image.confidence(0, 0), 0.999);
}

TEST(LikelihoodDecoder, NotANumberIsInvalidAndDisturbsNoNeighbour) {
  const LikelihoodSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, 20, 1);
  const DepthImage before = decode_pixels(setup.decoder, raw);
  raw[4 * 10 + 2] = nan;
  raw[4 * 11] = infinity;
  raw[4 * 12 + 3] = -infinity;
  const DepthImage after = decode_pixels(setup.decoder, raw);
  const std::vector<double> positions = depth_bins_of(setup.decoder, raw);
  std::vector<std::int32_t> bins(20);
  setup.decoder.decode_bins(raw.data(), 20, bins.data());
  for (std::size_t i = 0; i < 20; ++i) {
    const bool is_bad = i >= 10 && i < 13;
    EXPECT_EQ(std::isnan(positions[i]), is_bad);
    EXPECT_EQ(bins[i] == -1, is_bad);
    if (is_bad) {
      EXPECT_EQ(after.status.pixels[i], PixelStatus::invalid);
      EXPECT_TRUE(std::isnan(after.depth_m.pixels[i]));
    } else {
      EXPECT_EQ(after.status.pixels[i], before.status.pixels[i]);
      EXPECT_EQ(after.depth_m.pixels[i], before.depth_m.pixels[i]);
    }
  }
}

TEST(LikelihoodDecoder, BadPixelsHaveTheStatusOfZncc) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const LikelihoodSetup setup("hamiltonian-k4", camera);
  const Decoder zncc(setup.decoder.table());
  std::vector<float> faint, ambient_alone(4, 700.0f);
  setup.append_expected(faint, 50.0, 30.0, 1e4);
  for (const auto& [raw, status] :
       {std::pair{faint, PixelStatus::low_signal}, std::pair{ambient_alone, PixelStatus::no_return},
        std::pair{std::vector<float>(4, 0.0f), PixelStatus::no_return},
        std::pair{std::vector<float>(4, 5000.0f), PixelStatus::saturated},
        std::pair{std::vector<float>{1, nan, 1, 5000.0f}, PixelStatus::invalid}}) {
    const DepthImage image = decode_pixels(setup.decoder, raw);
    EXPECT_EQ(image.status(0, 0), status) << name_of(status);
    EXPECT_EQ(image.status(0, 0), zncc.decode(frame_of(raw, 4)).status(0, 0));
    EXPECT_EQ(std::isnan(image.depth_m(0, 0)), status != PixelStatus::low_signal);
  }
}

TEST(LikelihoodDecoder, NegativeSignalIsNoReturn) {
  // A curve that stays on one side: what points away from all of it fits only negative signal.
  Eigen::MatrixXd correlation(20, 3);
  for (int n = 0; n < 20; ++n) correlation.row(n) << 0.0, 1.0, 0.02 * n;
  const LikelihoodDecoder decoder(make_decoding_table(correlation, 10.0));
  EXPECT_EQ(decode_pixels(decoder, {100.0f, 0.0f, 50.0f}).status(0, 0), PixelStatus::no_return);
  EXPECT_EQ(decode_pixels(decoder, {0.0f, 100.0f, 20.0f}).status(0, 0), PixelStatus::ok);
}

TEST(LikelihoodDecoder, HugeNumbersAreDecodedNotOverflown) {
  const LikelihoodSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e4, 50.0, 0.0);
  for (float& value : raw) value *= 3e34f;
  EXPECT_NEAR(depth_bins_of(setup.decoder, raw)[0], 50.0, 1e-3);
}

struct NoiseCase {
  const char* code;
  int taps = 1;
  Readout readout = Readout::separate;
  std::vector<double> exposure_s;
};

class LikelihoodEstimatesOf : public testing::TestWithParam<NoiseCase> {};

TEST_P(LikelihoodEstimatesOf, AgreeWithMonteCarloAtHighSignal) {
  const NoiseCase& c = GetParam();
  Camera camera = camera_with("paper-10f0", c.taps, c.readout);
  camera.exposure_s.each_s = c.exposure_s;
  const LikelihoodSetup setup(c.code, camera);
  const int k_count = setup.decoder.measurements(), trials = 4000;
  for (const double truth_bin : {33.3, 121.7, 200.2}) {
    const Return r{1e6, truth_bin};
    const Eigen::VectorXd mean = setup.model.expected_electrons({&r, 1}, 1e5);
    const Eigen::VectorXd variance = setup.model.variance_e2({&r, 1}, 1e5);
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
    // A sampled deviation of n values is good to 1 / sqrt(2 n), here 1.1 %.
    EXPECT_NEAR(predicted_m.mean() / std::sqrt(depth_m.variance()), 1.0, 4 * 0.0112)
        << c.code << " at " << truth_bin;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Codes, LikelihoodEstimatesOf,
    testing::Values(NoiseCase{"sinusoid-k4"}, NoiseCase{"hamiltonian-k4"},
                    NoiseCase{
                        "hamiltonian-k5", 1, Readout::separate, {0.01, 0.02, 0.05, 0.08, 0.14}},
                    NoiseCase{"hamiltonian-k4", 2}));

TEST(LikelihoodDecoder, ConfidentPixelsAreRightAsOftenAsTheySay) {
  const LikelihoodSetup setup("hamiltonian-k5", camera_with("paper-30x"));
  const int pixels = 20000;
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e3, 3e3, pixels, 11);
  const DepthImage image = decode_pixels(setup.decoder, raw);
  RandomStream random(11, 0);
  constexpr int classes = 5;
  RunningStatistics said[classes], right[classes];
  for (int i = 0; i < pixels; ++i) {
    const double truth_m = random.uniform() * setup.camera.range_m();
    for (int k = 0; k < 5; ++k) random.normal();
    if (std::isnan(image.depth_m(0, i))) continue;
    const double error_m = std::abs(circular_difference(static_cast<double>(image.depth_m(0, i)),
                                                        truth_m, setup.camera.range_m()));
    const double confidence = image.confidence(0, i);
    const int at = std::min(classes - 1, static_cast<int>((confidence - 0.5) * 2 * classes));
    said[at].add(confidence);
    right[at].add(error_m < 0.1 * setup.camera.range_m());
  }
  // One rival is counted, so that the surest are a little less often right than they say.
  for (int c = 0; c < classes; ++c) {
    EXPECT_GT(said[c].count(), 1000);
    EXPECT_NEAR(said[c].mean(), right[c].mean(), 0.06) << "class " << c;
  }
}

}  // namespace
}  // namespace tofsmith
