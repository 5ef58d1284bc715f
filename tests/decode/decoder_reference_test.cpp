// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "decode_setup.hpp"
#include "each_target.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

/// @param every  stride of the pixels compared by golden-section search, which is slow
void expect_agreement(const Decoder& decoder, const std::vector<float>& raw, std::size_t every) {
  const ReferenceDecoder reference(decoder.table());
  const auto k_count = static_cast<std::size_t>(decoder.measurements());
  const std::size_t pixels = raw.size() / k_count;
  std::vector<std::int32_t> expected(pixels);
  for (std::size_t i = 0; i < pixels; ++i) expected[i] = reference.bin(&raw[i * k_count]);
  for_each_target([&] { ASSERT_EQ(bins_of(decoder, raw), expected); });

  const std::vector<double> positions = depth_bins_of(decoder, raw);
  for (std::size_t i = 0; i < pixels; i += every) {
    ASSERT_LE(std::abs(circular_difference(positions[i], expected[i], decoder.samples())), 1.0);
    const Eigen::VectorXd difference = reference.difference(&raw[i * k_count]);
    const DecodingTable& table = decoder.table();
    const double row = positions[i] * table.samples() / table.bin_count();
    // The quadratic interpolation of a smooth table misses the maximum by at most 1e-3 rows.
    ASSERT_NEAR(reference.score_at(difference, row),
                reference.best_score_beside(difference, reference.row(&raw[i * k_count])),
                1e-8 * difference.norm());
  }
}

// Debug builds and sanitizers test a sample only.
#ifdef NDEBUG
constexpr int pixels_per_level = 40000;
#else
constexpr int pixels_per_level = 500;
#endif

struct Case {
  const char* code;
  const char* camera;
  int samples = 240;
  int taps = 1;
  Readout readout = Readout::separate;
};

class DecoderOfCode : public testing::TestWithParam<Case> {};

TEST_P(DecoderOfCode, AgreesWithTheReferenceOnEveryPixel) {
  const Case& c = GetParam();
  Camera camera = camera_with(c.camera, c.taps, c.readout);
  camera.samples = c.samples;
  const DecodeSetup setup(c.code, camera);
  const int each = c.samples < 300 ? pixels_per_level : 1 + pixels_per_level * 60 / c.samples;
  std::vector<float> raw = pixels_at_all_light_levels(setup.decoder.table(), each);
  const std::vector<float> sunlit = noisy_pixels(setup.decoder.table(), 1e6, 1e8, each, 6);
  raw.insert(raw.end(), sunlit.begin(), sunlit.end());
  expect_agreement(setup.decoder, raw, 997);
}

INSTANTIATE_TEST_SUITE_P(
    Codes, DecoderOfCode,
    testing::Values(Case{"hamiltonian-k3", "paper-30x"}, Case{"hamiltonian-k4", "paper-10f0"},
                    Case{"hamiltonian-k5", "paper-30x"}, Case{"sinusoid-k4", "paper-5f0"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k8", "paper-30x", 252},
                    Case{"hamiltonian-k4", "paper-10f0", 240, 2},
                    Case{"hamiltonian-k5", "paper-10f0", 240, 2, Readout::difference}));
INSTANTIATE_TEST_SUITE_P(
    FineGrids, DecoderOfCode,
    testing::Values(
        Case{"hamiltonian-k3", "paper-30x", 1020}, Case{"hamiltonian-k4", "paper-10f0", 1020},
        Case{"hamiltonian-k5", "paper-30x", 1020}, Case{"gray-k4", "paper-30x", 1024},
        Case{"multifrequency-k5", "paper-10f0", 1000}, Case{"hamiltonian-k8", "paper-30x", 1008},
        Case{"hamiltonian-k4", "paper-10f0", 1020, 2}, Case{"hamiltonian-k3", "paper-10f0", 10020},
        Case{"hamiltonian-k4", "paper-10f0", 10020}, Case{"hamiltonian-k5", "paper-10f0", 10020},
        Case{"gray-k4", "paper-30x", 10016}, Case{"hamiltonian-k8", "paper-30x", 10080}));

TEST(Decoder, IsIdenticalOnEveryInstructionSet) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0", 2));
  const RawFrames frame = frame_of(noisy_pixels(setup.decoder.table(), 2e3, 1e4, 3000, 9), 10);
  const DepthImage expected = setup.decoder.decode(frame);
  for_each_target([&] {
    const DepthImage image = setup.decoder.decode(frame);
    EXPECT_EQ(image.depth_m.pixels, expected.depth_m.pixels);
    EXPECT_EQ(image.confidence.pixels, expected.confidence.pixels);
    EXPECT_EQ(image.deviation_m.pixels, expected.deviation_m.pixels);
    EXPECT_EQ(image.status.pixels, expected.status.pixels);
  });
}

TEST(Decoder, AgreesWithTheReferenceAtAnyRank) {
  for (const char* code : {"hamiltonian-k6", "sinusoid-k8", "multifrequency-1x3-2x3-3x3-4x3"}) {
    const DecodeSetup setup(code, camera_with("paper-30x"));
    expect_agreement(setup.decoder,
                     pixels_at_all_light_levels(setup.decoder.table(), pixels_per_level / 50), 397);
  }
}

TEST(Decoder, AgreesWithTheReferenceOnHugeNumbers) {
  for (const char* code :
       {"hamiltonian-k3", "hamiltonian-k4", "hamiltonian-k5", "hamiltonian-k6"}) {
    const DecodeSetup setup(code, camera_with("paper-30x"));
    std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, 500, 3);
    for (std::size_t i = 0; i < raw.size(); ++i) raw[i] *= i % 2000 < 1000 ? 1e33f : 3e34f;
    raw[0] = std::numeric_limits<float>::max();
    expect_agreement(setup.decoder, raw, raw.size());
  }
}

TEST(Decoder, AgreesWithTheReferenceOnTies) {
  // Small integers often tie exactly.
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  std::vector<float> raw;
  for (int a = -6; a <= 6; ++a)
    for (int b = -6; b <= 6; ++b)
      for (int c = -6; c <= 6; ++c)
        for (const int value : {a, b, c}) raw.push_back(static_cast<float>(value));
  expect_agreement(setup.decoder, raw, raw.size());
}

TEST(Decoder, AgreesWithTheReferenceWithUnequalExposures) {
  Camera camera = camera_with("paper-10f0");
  camera.exposure_s.each_s = {0.02, 0.05, 0.1, 0.13};
  const DecodeSetup setup("hamiltonian-k4", camera);
  expect_agreement(setup.decoder,
                   pixels_at_all_light_levels(setup.decoder.table(), pixels_per_level / 10), 397);
}

}  // namespace
}  // namespace tofsmith
