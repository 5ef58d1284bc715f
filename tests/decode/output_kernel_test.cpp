// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The kernel in single precision against the definition of every output in double.
#include "decode/output/output_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "output_setup.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

void expect_agreement(const DecodingTable& table, const std::vector<float>& raw) {
  const Matched matched(table, raw);
  for_each_target([&] {
    const Outputs outputs = matched.outputs();
    EXPECT_EQ(outputs.bin, matched.expected().bin);  // rows
    expect_definition(outputs, matched);
    expect_near(outputs.confidence, matched.expected().confidence, 0.0, 5e-3, "confidence");
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
      ASSERT_LE(off_rows(outputs.depth_m[i], matched.decoding_of(i).depth_row, table),
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
    ASSERT_LE(off_rows(outputs.depth_m[i], matched.decoding_of(i).depth_row, table), 1.5e-3) << i;
}

TEST(OutputKernel, WrapsDepthsAtTheEndOfTheRange) {
  const DecodeSetup setup("sinusoid-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  std::vector<float> raw;
  for (int i = -100; i <= 100; ++i)
    setup.append_expected(raw, 1e5, i < 0 ? table.bin_count() + i * 0.01 : i * 0.01, 1e2);
  setup.append_expected(raw, 1e5, table.bin_count() - 1e-7, 1e2);
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
    ASSERT_LE(off_rows(outputs.depth_m[i], matched.decoding_of(i).depth_row, table), 1e-4) << i;
  }
}

}  // namespace
}  // namespace tofsmith
