// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "pixel_laws.hpp"

namespace tofsmith {
namespace {

TEST(PixelStatus, HasAName) {
  for (const PixelStatus status : all_pixel_statuses) EXPECT_FALSE(name_of(status).empty());
  EXPECT_EQ(name_of(PixelStatus::no_return), "no_return");
  EXPECT_THROW(name_of(static_cast<PixelStatus>(77)), std::invalid_argument);
}

TEST(Decoder, StrongSignalIsOk) {
  expect_strong_signal_is_ok(DecodeSetup("hamiltonian-k4", camera_with("paper-10f0")), 1e5, 10.0,
                             10.0);
}

TEST(Decoder, NaNIsInvalidAndDoesNotAffectNeighbours) {
  expect_not_a_number_disturbs_no_neighbour(
      DecodeSetup("hamiltonian-k4", camera_with("paper-10f0")).decoder, 300, 1.0);
}

TEST(Decoder, HugeValuesDoNotOverflow) {
  expect_huge_numbers_are_decoded(DecodeSetup("hamiltonian-k3", camera_with("paper-30x")));
}

TEST(Decoder, AmbientLightAloneIsNoReturn) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  for (const float level : {0.0f, 700.0f, 12345.678f}) {
    const DepthImage image = decode_pixels(setup.decoder, std::vector<float>(4, level));
    EXPECT_EQ(image.status(0, 0), PixelStatus::no_return);
    EXPECT_TRUE(std::isnan(image.depth_m(0, 0)));
  }
}

TEST(Decoder, NegativeSignalIsNoReturn) { expect_negative_signal_is_no_return<Decoder>(); }

TEST(Decoder, NegativeMeasurementsAreData) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  std::vector<float> raw;
  setup.append_expected(raw, 1e5, 100.25, 0.0);
  for (float& value : raw) value -= 20000.0f;
  const DepthImage image = decode_pixels(setup.decoder, raw);
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
  const DepthImage image = decode_pixels(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::saturated);
  EXPECT_TRUE(std::isfinite(image.depth_m(0, 0)));
  const DepthImage white = decode_pixels(setup.decoder, std::vector<float>(4, 5000.0f));
  EXPECT_EQ(white.status(0, 0), PixelStatus::saturated);
  EXPECT_TRUE(std::isnan(white.depth_m(0, 0)));
}

TEST(Decoder, FaintSignalIsLowSignal) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw;
  setup.append_expected(raw, 100.0, 30.0, 1e5);
  const DepthImage image = decode_pixels(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::low_signal);
  EXPECT_NEAR(image.depth_m(0, 0), setup.camera.range_m() / 8, 1e-2);
}

/// Electrons half-way between the closest directions of depths at least 3 m apart.
std::vector<float> between_two_depths(const DecodingTable& table) {
  Eigen::MatrixXd units = table.correlation.colwise() - table.correlation.rowwise().mean();
  units.rowwise().normalize();
  const int samples = table.samples();
  int first = 0, second = samples / 2;
  for (int a = 0; a < samples; ++a)
    for (int b = a; b < samples; ++b) {
      const double apart_m = table.row_m() * std::abs(circular_difference(a, b, samples));
      if (apart_m > 3.0 && units.row(a).dot(units.row(b)) > units.row(first).dot(units.row(second)))
        first = a, second = b;
    }
  const Eigen::RowVectorXd both = 300.0 * (units.row(first) + units.row(second)).array() + 1000.0;
  return {both.begin(), both.end()};
}

TEST(Decoder, APixelBetweenTwoDepthsIsAmbiguous) {
  const DecodeOptions any_residual{.false_alarm_rate = 0.0};
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-30x"), any_residual);
  const std::vector<float> raw = between_two_depths(setup.decoder.table());
  const DepthImage image = decode_pixels(setup.decoder, raw);
  EXPECT_EQ(image.status(0, 0), PixelStatus::ambiguous);
  EXPECT_LT(image.confidence(0, 0), 0.9f);
  EXPECT_TRUE(std::isfinite(image.depth_m(0, 0)));
  DecodeOptions trusting = any_residual;
  trusting.min_confidence = 0.0;
  const DecodeSetup trusting_setup("hamiltonian-k5", camera_with("paper-30x"), trusting);
  EXPECT_EQ(decode_pixels(trusting_setup.decoder, raw).status(0, 0), PixelStatus::ok);
}

TEST(Decoder, ConfidenceIsTheFractionOfCorrectDepths) {
  for (const char* code : {"hamiltonian-k5", "pulsed-multifrequency-k5"})
    expect_right_as_often_as_said(DecodeSetup(code, camera_with("paper-10f0")),
                                  {1.25e2, 2.5e2, 5e2, 1e3, 2e3, 4e3, 8e3}, 1e4, 0.06);
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
  for (const double truth_bin : {33.3, 121.7, 200.2}) {
    const PixelEstimates found = estimates_at(setup, truth_bin, c.signal, c.ambient);
    EXPECT_NEAR(found.ratio(), 1.0, 0.1) << truth_bin;
    EXPECT_NEAR(found.signal.mean(), c.signal, 4 * found.signal.standard_error() + 1e-3 * c.signal);
    if (c.readout == Readout::separate) {
      EXPECT_NEAR(found.ambient.mean(), c.ambient,
                  4 * found.ambient.standard_error() + 1e-3 * c.signal);
    } else {
      EXPECT_TRUE(std::isnan(found.ambient.mean()));
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
