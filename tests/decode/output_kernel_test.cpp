// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The kernel in single precision against the definition of every output in double.
#include "decode/output_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "output_setup.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

/// Like depth_bin of the definition, on the circle, in bins.
double off_bins(float depth_m, double depth_bin, const DecodingTable& table) {
  return std::abs(circular_difference(depth_m / table.bin_m(), depth_bin, table.samples()));
}

void expect_near(const std::vector<float>& values, const std::vector<float>& expected, double share,
                 double amount, const char* plane) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(std::isfinite(values[i]), std::isfinite(expected[i])) << plane << " of pixel " << i;
    if (!std::isfinite(expected[i])) continue;
    ASSERT_NEAR(values[i], expected[i], share * std::abs(expected[i]) + amount)
        << plane << " of pixel " << i;
  }
}

/// Noise is that of the middle of a quarter of a chord, and differs much within it only where a
/// bright pixel's shot noise vanishes.
void expect_similar(const std::vector<float>& deviations, const std::vector<float>& expected) {
  expect_near(deviations, expected, 1.0, 0.0, "deviation");
  double sum = 0.0;
  int finite = 0, others = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!std::isfinite(expected[i])) continue;
    const double share = std::abs(deviations[i] / expected[i] - 1.0);
    sum += share;
    ++finite;
    others += share > 0.1;
  }
  EXPECT_LE(sum, 0.01 * finite);
  EXPECT_LE(others, 0.02 * finite);
}

void expect_agreement(const DecodingTable& table, const std::vector<float>& raw) {
  const Matched matched(table, raw);
  const Outputs expected = matched.expected();
  const double float_error_bin = 1e-4 + 1.2e-7 * table.samples();
  for_each_target([&] {
    const Outputs outputs = matched.outputs();
    int other_status = 0;
    for (std::size_t i = 0; i < matched.pixels(); ++i) {
      other_status += outputs.status[i] != expected.status[i];
      ASSERT_EQ(std::isnan(outputs.depth_m[i]), std::isnan(expected.depth_m[i])) << i;
      if (std::isnan(expected.depth_m[i])) continue;
      const double depth_bin = matched.decoding_of(i).depth_bin;
      ASSERT_LE(off_bins(outputs.depth_m[i], depth_bin, table), float_error_bin) << i;
      ASSERT_GE(outputs.depth_m[i], 0.0f);
      ASSERT_LT(outputs.depth_m[i], static_cast<float>(table.range_m));
      const double to_edge = std::abs(depth_bin - std::floor(depth_bin) - 0.5);
      if (to_edge <= float_error_bin) continue;
      ASSERT_EQ(outputs.bin[i], expected.bin[i]) << i;
    }
    // Noise at the best bin moves the thresholds a little.
    EXPECT_LE(other_status, 5 + static_cast<int>(matched.pixels()) / 500);
    const double brightest =
        *std::max_element(raw.begin(), raw.end()) / table.exposure_s.minCoeff();
    expect_near(outputs.signal, expected.signal, 2e-6, 1e-6 * brightest, "signal");
    expect_near(outputs.ambient, expected.ambient, 2e-6, 1e-6 * brightest, "ambient");
    expect_near(outputs.confidence, expected.confidence, 0.0, 5e-3, "confidence");
    expect_similar(outputs.deviation_m, expected.deviation_m);
  });
}

struct Case {
  const char* code;
  const char* camera;
  int taps = 1;
  Readout readout = Readout::separate;
};

class OutputsOfCode : public testing::TestWithParam<Case> {};

TEST_P(OutputsOfCode, AgreeWithDoublePrecision) {
  const Case& c = GetParam();
  const DecodeSetup setup(c.code, camera_with(c.camera, c.taps, c.readout));
  const DecodingTable& table = setup.decoder.table();
  expect_agreement(table, pixels_at_all_light_levels(table, 700));
}

INSTANTIATE_TEST_SUITE_P(
    Codes, OutputsOfCode,
    testing::Values(Case{"hamiltonian-k3", "paper-30x"}, Case{"hamiltonian-k4", "paper-10f0"},
                    Case{"hamiltonian-k5", "paper-30x"}, Case{"sinusoid-k4", "paper-5f0"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k6", "paper-30x"}, Case{"sinusoid-k8", "paper-30x"},
                    Case{"hamiltonian-k4", "paper-10f0", 2},
                    Case{"hamiltonian-k5", "paper-10f0", 2, Readout::difference}));

TEST(OutputKernel, AgreesWithDoublePrecisionWithUnequalExposures) {
  Camera camera = camera_with("paper-10f0");
  camera.exposure_s.each_s = {0.02, 0.05, 0.1, 0.13};
  const DecodeSetup setup("hamiltonian-k4", camera);
  const DecodingTable& table = setup.decoder.table();
  expect_agreement(table, pixels_at_all_light_levels(table, 300));
}

TEST(OutputKernel, FindsDepthsBetweenBinsInAnyLight) {
  for (const int samples : {240, 1020, 10020}) {
    Camera camera = camera_with("paper-30x");
    camera.samples = samples;
    const DecodeSetup setup("hamiltonian-k3", camera);
    const DecodingTable& table = setup.decoder.table();
    std::vector<float> raw;
    for (int i = 0; i < 300; ++i)
      setup.append_expected(raw, 1e4, samples * i / 300.0 + 0.37 * i / 300.0, 1e6);
    const Matched matched(table, raw);
    const Outputs outputs = matched.outputs();
    for (std::size_t i = 0; i < matched.pixels(); ++i)
      ASSERT_LE(off_bins(outputs.depth_m[i], matched.decoding_of(i).depth_bin, table),
                samples > 10000 ? 0.1 : 0.02)
          << samples << " samples, pixel " << i;
  }
}

TEST(OutputKernel, AddsFractionsToHighBins) {
  // A circle: the angle is the depth.
  const int samples = 10000;
  Eigen::MatrixXd correlation(samples, 3);
  for (int n = 0; n < samples; ++n)
    for (int k = 0; k < 3; ++k)
      correlation(n, k) = std::cos(2 * std::numbers::pi * (n / double(samples) - k / 3.0));
  const DecodingTable table = make_decoding_table(correlation, 9.99308193333);
  std::vector<float> raw;
  for (int i = 0; i < 512; ++i)
    for (int k = 0; k < 3; ++k)
      raw.push_back(
          static_cast<float>(1000.0 * std::cos(2 * std::numbers::pi * (i / 512.1 - k / 3.0))));
  const Matched matched(table, raw);
  const Outputs outputs = matched.outputs();
  for (std::size_t i = 0; i < matched.pixels(); ++i)
    ASSERT_LE(off_bins(outputs.depth_m[i], matched.decoding_of(i).depth_bin, table), 1.5e-3) << i;
}

TEST(OutputKernel, WrapsDepthsAtTheEndOfTheRange) {
  const DecodeSetup setup("sinusoid-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  std::vector<float> raw;
  for (int i = -100; i <= 100; ++i)
    setup.append_expected(raw, 1e5, i < 0 ? table.samples() + i * 0.01 : i * 0.01, 1e2);
  setup.append_expected(raw, 1e5, table.samples() - 1e-7, 1e2);
  expect_agreement(table, raw);
}

TEST(OutputKernel, NeedsNoContrastEverywhere) {
  // Bins 3 and 4 see all measurements alike.
  Eigen::MatrixXd correlation(12, 3);
  for (int n = 0; n < 12; ++n) correlation.row(n) << n % 5, n, 12 - n;
  correlation.row(3).setConstant(5.0);
  correlation.row(4).setConstant(7.0);
  DecodingTable table = make_decoding_table(correlation, 10.0);
  table.constant_variance_e2.setOnes();
  std::vector<float> raw;
  RandomStream random(5, 0);
  for (int i = 0; i < 3 * 400; ++i) raw.push_back(static_cast<float>(10.0 * random.normal()));
  const Matched matched(table, raw);
  const Outputs outputs = matched.outputs(), expected = matched.expected();
  for (std::size_t i = 0; i < matched.pixels(); ++i) {
    ASSERT_EQ(std::isnan(outputs.depth_m[i]), std::isnan(expected.depth_m[i])) << i;
    if (std::isnan(expected.depth_m[i])) continue;
    ASSERT_LE(off_bins(outputs.depth_m[i], matched.decoding_of(i).depth_bin, table), 1e-4) << i;
  }
}

}  // namespace
}  // namespace tofsmith
