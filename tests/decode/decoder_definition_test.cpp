// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// All planes of the decoder against their definition in double.
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
};

/// The vector of a pixel in single precision and the noise at a bin instead of between bins change
/// confidence a little.
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

TEST_P(PlanesOfCode, AgreeWithTheirDefinition) {
  const Case& c = GetParam();
  Camera camera = camera_with(c.camera, c.taps, c.readout);
  camera.samples = c.samples;
  const DecodeSetup setup(c.code, camera);
  const DecodingTable& table = setup.decoder.table();
  const std::vector<float> raw = pixels_at_all_light_levels(table, 700);
  const Matched matched(table, raw);
  const Outputs expected = matched.expected();
  for_each_target([&] {
    Outputs outputs(matched.pixels());
    setup.decoder.decode(RawView::interleaved(raw.data(), 1, static_cast<int>(matched.pixels()),
                                              setup.decoder.measurements()),
                         outputs.view());
    for (std::size_t i = 0; i < matched.pixels(); ++i)
      ASSERT_EQ(outputs.bin[i], table.nearest_bin(expected.bin[i])) << i;
    expect_definition(outputs, matched);
    expect_close_confidence(outputs.confidence, expected.confidence);
  });
}

INSTANTIATE_TEST_SUITE_P(
    Codes, PlanesOfCode,
    testing::Values(Case{"sinusoid-k4", "paper-5f0"}, Case{"hamiltonian-k3", "paper-30x"},
                    Case{"hamiltonian-k4", "paper-10f0"}, Case{"hamiltonian-k5", "paper-30x"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k6", "paper-30x", 1, Readout::separate, 480},
                    Case{"hamiltonian-k4", "paper-10f0", 2},
                    Case{"hamiltonian-k5", "paper-10f0", 2, Readout::difference}));

}  // namespace
}  // namespace tofsmith
