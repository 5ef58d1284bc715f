// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What a decoder says of a pixel besides its depth.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "decode_setup.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

DepthImage decode_pixel(const Decoder& decoder, const std::vector<float>& raw) {
  return decoder.decode(frame_of(raw, decoder.measurements()));
}

TEST(PixelStatus, HasAName) {
  for (const PixelStatus status : all_pixel_statuses) EXPECT_FALSE(name_of(status).empty());
  EXPECT_EQ(name_of(PixelStatus::no_return), "no_return");
  EXPECT_THROW(name_of(static_cast<PixelStatus>(77)), std::invalid_argument);
}

TEST(Decoder, StrongSignalIsOk) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e5, 30.0, 1e3);
  const DepthImage image = decode_pixel(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::ok);
  EXPECT_NEAR(image.depth_m(0, 0), setup.camera.range_m() / 8, 1e-3);
  EXPECT_NEAR(image.signal_e_per_s(0, 0), 1e5, 10.0);
  EXPECT_NEAR(image.ambient_e_per_s(0, 0), 1e3, 10.0);
  EXPECT_GT(image.confidence(0, 0), 0.999);
}

TEST(Decoder, NotANumberIsInvalidAndDisturbsNoNeighbour) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, 300, 1);
  const DepthImage before = decode_pixel(setup.decoder, raw);
  raw[4 * 100 + 2] = nan;
  raw[4 * 101] = infinity;
  raw[4 * 102 + 3] = -infinity;
  for (int k = 0; k < 4; ++k) raw[4 * 103 + static_cast<std::size_t>(k)] = infinity;
  const DepthImage after = decode_pixel(setup.decoder, raw);
  const auto bins = bins_of(setup.decoder, raw);
  const auto positions = depth_bins_of(setup.decoder, raw);
  for (int i = 0; i < 300; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i >= 100 && i < 104) {
      EXPECT_EQ(after.status.pixels[at], PixelStatus::invalid);
      EXPECT_TRUE(std::isnan(after.depth_m.pixels[at]));
      EXPECT_EQ(bins[at], -1);
      EXPECT_TRUE(std::isnan(positions[at]));
    } else {
      EXPECT_EQ(after.status.pixels[at], before.status.pixels[at]);
      EXPECT_EQ(after.depth_m.pixels[at], before.depth_m.pixels[at]);
      EXPECT_EQ(after.confidence.pixels[at], before.confidence.pixels[at]);
    }
  }
}

TEST(Decoder, HugeNumbersAreDecodedNotOverflown) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e4, 50.0, 0.0);
  for (float& value : raw) value *= 3e34f;
  EXPECT_NEAR(depth_bins_of(setup.decoder, raw)[0], 50.0, 1e-3);
}

TEST(Decoder, AmbientLightAloneIsNoReturn) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  for (const float level : {0.0f, 700.0f, 12345.678f}) {
    const DepthImage image = decode_pixel(setup.decoder, std::vector<float>(4, level));
    EXPECT_EQ(image.status(0, 0), PixelStatus::no_return);
    EXPECT_TRUE(std::isnan(image.depth_m(0, 0)));
  }
}

TEST(Decoder, NegativeSignalIsNoReturn) {
  // A curve that stays on one side: what points away from all of it fits only negative signal.
  Eigen::MatrixXd correlation(20, 3);
  for (int n = 0; n < 20; ++n) correlation.row(n) << 0.0, 1.0, 0.02 * n;
  const Decoder decoder(make_decoding_table(correlation, 10.0));
  const DepthImage image = decode_pixel(decoder, {100.0f, 0.0f, 50.0f});
  EXPECT_EQ(image.status(0, 0), PixelStatus::no_return);
  EXPECT_EQ(decode_pixel(decoder, {0.0f, 100.0f, 20.0f}).status(0, 0), PixelStatus::ok);
}

TEST(Decoder, NegativeMeasurementsAreData) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e5, 100.25, 0.0);
  for (float& value : raw) value -= 20000.0f;
  const DepthImage image = decode_pixel(setup.decoder, raw);
  EXPECT_NEAR(image.depth_m(0, 0), 100.25 * setup.camera.bin_m(), 1e-4);
  EXPECT_LT(image.ambient_e_per_s(0, 0), 0.0f);
}

TEST(Decoder, ClippedPixelsAreSaturatedButKeepTheirDepth) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const DecodeSetup setup("hamiltonian-k4", camera);
  std::vector<float> raw;
  setup.append_expected(raw, 1e5, 77.0, 1e4);
  for (float& value : raw) value = std::min(value, 5000.0f);
  const DepthImage image = decode_pixel(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::saturated);
  EXPECT_TRUE(std::isfinite(image.depth_m(0, 0)));
  const DepthImage white = decode_pixel(setup.decoder, std::vector<float>(4, 5000.0f));
  EXPECT_EQ(white.status(0, 0), PixelStatus::saturated);
  EXPECT_TRUE(std::isnan(white.depth_m(0, 0)));
}

TEST(Decoder, FaintSignalIsLowSignal) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw;
  setup.append_expected(raw, 100.0, 30.0, 1e5);
  const DepthImage image = decode_pixel(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::low_signal);
  EXPECT_NEAR(image.depth_m(0, 0), setup.camera.range_m() / 8, 1e-2);
}

/// Electrons half way between the two depths, at least 3 m apart, whose directions are closest.
std::vector<float> between_two_depths(const DecodingTable& table) {
  Eigen::MatrixXd units = table.correlation.colwise() - table.correlation.rowwise().mean();
  units.rowwise().normalize();
  const int samples = table.samples();
  int first = 0, second = samples / 2;
  for (int a = 0; a < samples; ++a)
    for (int b = a; b < samples; ++b) {
      const double apart_m = table.bin_m() * std::abs(circular_difference(a, b, samples));
      if (apart_m > 3.0 && units.row(a).dot(units.row(b)) > units.row(first).dot(units.row(second)))
        first = a, second = b;
    }
  const Eigen::RowVectorXd both = 300.0 * (units.row(first) + units.row(second)).array() + 1000.0;
  return {both.begin(), both.end()};
}

TEST(Decoder, APixelBetweenTwoDepthsIsAmbiguous) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-30x"));
  const std::vector<float> raw = between_two_depths(setup.decoder.table());
  const DepthImage image = decode_pixel(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::ambiguous);
  EXPECT_LT(image.confidence(0, 0), 0.9f);
  EXPECT_TRUE(std::isfinite(image.depth_m(0, 0)));
  DecodeOptions trusting;
  trusting.minimum_confidence = 0.0;
  const DecodeSetup trusting_setup("hamiltonian-k5", camera_with("paper-30x"), trusting);
  EXPECT_EQ(decode_pixel(trusting_setup.decoder, raw).status(0, 0), PixelStatus::ok);
}

TEST(Decoder, ConfidentPixelsAreRightAsOftenAsTheySay) {
  // Of pixels sure to 1 - 1e-4, next to none may be far off; of unsure ones many are (far: outside
  // the main lobe, which is up to 2 m wide on each side).
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const int pixels = 20000;
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 2e3, 1e4, pixels, 11);
  const DepthImage image = decode_pixel(setup.decoder, raw);
  RandomStream random(11, 0);
  int sure = 0, sure_wrong = 0, unsure = 0, unsure_wrong = 0;
  for (int i = 0; i < pixels; ++i) {
    const double truth_m = random.uniform() * setup.camera.range_m();
    for (int k = 0; k < 5; ++k) random.normal();
    const double error_m = std::abs(circular_difference(static_cast<double>(image.depth_m(0, i)),
                                                        truth_m, setup.camera.range_m()));
    const float confidence = image.confidence(0, i);
    if (confidence > 0.9999f) ++sure, sure_wrong += error_m > 2.0;
    if (confidence < 0.8f) ++unsure, unsure_wrong += error_m > 2.0;
  }
  EXPECT_GT(sure, 100);
  EXPECT_GT(unsure, 1000);
  EXPECT_LE(sure_wrong, 0.005 * sure);
  EXPECT_GE(unsure_wrong, 0.1 * unsure);
}

struct NoiseCase {
  const char* code;
  int taps;
  Readout readout;
  double signal, ambient;
};

class EstimatesOf : public testing::TestWithParam<NoiseCase> {};

TEST_P(EstimatesOf, AgreeWithMonteCarloAtHighSignal) {
  const NoiseCase c = GetParam();
  const DecodeSetup setup(c.code, camera_with("paper-10f0", c.taps, c.readout));
  const DecodingTable& table = setup.decoder.table();
  const int k_count = table.measurements(), trials = 4000;
  for (const double truth_bin : {33.3, 121.7, 200.2}) {
    const Return r{c.signal, truth_bin};
    const Eigen::VectorXd mean = setup.model.expected_electrons({&r, 1}, c.ambient);
    const Eigen::VectorXd variance = setup.model.variance_e2({&r, 1}, c.ambient);
    RandomStream random(3, static_cast<std::uint64_t>(truth_bin));
    std::vector<float> raw;
    for (int i = 0; i < trials; ++i)
      for (int k = 0; k < k_count; ++k)
        raw.push_back(static_cast<float>(mean[k] + std::sqrt(variance[k]) * random.normal()));
    const DepthImage image = decode_pixel(setup.decoder, raw);
    RunningStatistics depth_m, signal, ambient, predicted_m;
    for (int i = 0; i < trials; ++i) {
      depth_m.add(image.depth_m(0, i));
      signal.add(image.signal_e_per_s(0, i));
      ambient.add(image.ambient_e_per_s(0, i));
      predicted_m.add(image.predicted_standard_deviation_m(0, i));
    }
    EXPECT_NEAR(predicted_m.mean() / std::sqrt(depth_m.variance()), 1.0, 0.1) << truth_bin;
    EXPECT_NEAR(signal.mean(), c.signal, 4 * signal.standard_error() + 1e-3 * c.signal);
    if (c.readout == Readout::separate) {
      EXPECT_NEAR(ambient.mean(), c.ambient, 4 * ambient.standard_error() + 1e-3 * c.signal);
    } else {
      EXPECT_TRUE(std::isnan(ambient.mean()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Codes, EstimatesOf,
    testing::Values(NoiseCase{"hamiltonian-k3", 1, Readout::separate, 1e5, 1e3},
                    NoiseCase{"hamiltonian-k4", 1, Readout::separate, 1e5, 1e5},
                    NoiseCase{"hamiltonian-k5", 1, Readout::separate, 1e6, 1e2},
                    NoiseCase{"sinusoid-k4", 1, Readout::separate, 1e5, 1e4},
                    NoiseCase{"hamiltonian-k4", 2, Readout::separate, 1e5, 1e4},
                    NoiseCase{"hamiltonian-k5", 2, Readout::difference, 1e5, 1e4}));

}  // namespace
}  // namespace tofsmith
