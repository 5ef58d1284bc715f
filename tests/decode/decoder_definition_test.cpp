// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "output_setup.hpp"

namespace tofsmith {
namespace {

struct Case {
  const char* code;
  const char* camera;
  int taps = 1;
  Readout readout = Readout::separate;
  int samples = 240;
  bool has_equal_exposures = true;
};

/// Confidence differs slightly because the kernel works in single precision and evaluates the noise
/// at a bin instead of between bins.
void expect_close_confidence(const std::vector<float>& confidence,
                             const std::vector<float>& expected) {
  double sum = 0.0;
  int finite = 0, far_off = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(std::isnan(confidence[i]), std::isnan(expected[i])) << i;
    if (std::isnan(expected[i])) continue;
    const double off = std::abs(confidence[i] - expected[i]);
    sum += off;
    ++finite;
    far_off += off > 0.05;
  }
  EXPECT_LE(sum, 2e-3 * finite);
  EXPECT_LE(far_off, 0.01 * finite);
}

class PlanesOfCode : public testing::TestWithParam<Case> {};

void expect_definition_of(const Decoder& decoder, const std::vector<float>& raw) {
  const DecodingTable& table = decoder.table();
  const Matched matched(table, raw);
  const Outputs expected = matched.expected();
  for_each_target([&] {
    Outputs outputs(matched.pixels());
    decoder.decode(RawView::interleaved(raw.data(), 1, static_cast<int>(matched.pixels()),
                                        decoder.measurements()),
                   outputs.view());
    for (std::size_t i = 0; i < matched.pixels(); ++i)
      ASSERT_EQ(outputs.bin.pixels[i], table.nearest_bin(expected.bin.pixels[i])) << i;
    expect_definition(outputs, matched);
    expect_close_confidence(outputs.confidence.pixels, expected.confidence.pixels);
  });
}

TEST_P(PlanesOfCode, AgreeWithTheirDefinition) {
  const Case& c = GetParam();
  Camera camera = camera_with(c.camera, c.taps, c.readout);
  camera.samples = c.samples;
  if (!c.has_equal_exposures) camera.exposure_s.each_s = {0.02, 0.05, 0.1, 0.13};
  const DecodeSetup setup(c.code, camera);
  expect_definition_of(setup.decoder, pixels_at_all_light_levels(setup.decoder.table(), 700));
}

TEST(Decoder, WrapsDepthAtTheEndOfTheRange) {
  const DecodeSetup setup("sinusoid-k4", camera_with("paper-10f0"));
  const int bins = setup.decoder.table().bin_count();
  std::vector<float> raw;
  for (int i = -100; i <= 100; ++i)
    setup.append_expected(raw, 1e5, i < 0 ? bins + i * 0.01 : i * 0.01, 1e2);
  setup.append_expected(raw, 1e5, bins - 1e-7, 1e2);
  expect_definition_of(setup.decoder, raw);
}

TEST(Decoder, AllowsDepthsWithoutContrast) {
  // All measurements are equal at bins 3 and 4.
  Eigen::MatrixXd correlation(12, 3);
  for (int n = 0; n < 12; ++n) correlation.row(n) << n % 5, n, 12 - n;
  correlation.row(3).setConstant(5.0);
  correlation.row(4).setConstant(7.0);
  DecodingTable table = make_decoding_table(correlation, 10.0);
  table.constant_variance_e2.setOnes();
  std::vector<float> raw;
  RandomStream random(5, 0);
  for (int i = 0; i < 3 * 400; ++i) raw.push_back(static_cast<float>(10.0 * random.normal()));
  const std::vector<std::int32_t> bins = bins_of(Decoder(table), raw);
  const Outputs expected = Matched(table, raw).expected();
  for (std::size_t i = 0; i < bins.size(); ++i)
    ASSERT_EQ(bins[i], table.nearest_bin(expected.bin.pixels[i])) << i;
}

INSTANTIATE_TEST_SUITE_P(
    Codes, PlanesOfCode,
    testing::Values(Case{"sinusoid-k4", "paper-5f0"}, Case{"hamiltonian-k3", "paper-30x"},
                    Case{"hamiltonian-k4", "paper-10f0"}, Case{"hamiltonian-k5", "paper-30x"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k6", "paper-30x", 1, Readout::separate, 480},
                    Case{"hamiltonian-k4", "paper-10f0", 2},
                    Case{"hamiltonian-k5", "paper-10f0", 2, Readout::difference},
                    Case{"hamiltonian-k4", "paper-10f0", 1, Readout::separate, 240, false},
                    Case{"hamiltonian-k3", "paper-30x", 1, Readout::separate, 1020}));

}  // namespace
}  // namespace tofsmith
