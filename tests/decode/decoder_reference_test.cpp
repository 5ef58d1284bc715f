// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The fast decoder against the plain reference, pixel by pixel.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "decode_setup.hpp"
#include "reference_decoder.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

/// Runs `body` once for every instruction set this machine offers.
template <typename Body>
void for_each_target(const Body& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// @param every  only so many pixels are held against the golden section, which is slow
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
    ASSERT_NEAR(reference.score_at(difference, positions[i]),
                reference.best_score_beside(difference, expected[i]), 1e-12 * difference.norm());
  }
}

std::vector<float> pixels_at_all_light_levels(const DecodingTable& table, int each) {
  std::vector<float> raw;
  std::uint64_t seed = 1;
  for (const auto& [signal, ambient] :
       {OperatingPoint{1e3, 1e5}, OperatingPoint{3e3, 1e3}, OperatingPoint{1e4, 1e4},
        OperatingPoint{1e5, 1e2}, OperatingPoint{1e7, 1e5}}) {
    const std::vector<float> more = noisy_pixels(table, signal, ambient, each, seed++);
    raw.insert(raw.end(), more.begin(), more.end());
  }
  return raw;
}

// Debug builds, slowed further by sanitizers, look at a sample.
#ifdef NDEBUG
constexpr int pixels_per_level = 40000;
#else
constexpr int pixels_per_level = 500;
#endif

struct Case {
  const char* code;
  const char* camera;
  int taps = 1;
  Readout readout = Readout::separate;
};

class DecoderOfCode : public testing::TestWithParam<Case> {};

TEST_P(DecoderOfCode, AgreesWithTheReferenceOnEveryPixel) {
  const Case& c = GetParam();
  const DecodeSetup setup(c.code, camera_with(c.camera, c.taps, c.readout));
  expect_agreement(setup.decoder,
                   pixels_at_all_light_levels(setup.decoder.table(), pixels_per_level), 997);
}

INSTANTIATE_TEST_SUITE_P(
    Codes, DecoderOfCode,
    testing::Values(Case{"hamiltonian-k3", "paper-30x"}, Case{"hamiltonian-k4", "paper-10f0"},
                    Case{"hamiltonian-k5", "paper-30x"}, Case{"sinusoid-k4", "paper-5f0"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k4", "paper-10f0", 2},
                    Case{"hamiltonian-k5", "paper-10f0", 2, Readout::difference}));

TEST(Decoder, SaysTheSameOnEveryInstructionSet) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0", 2));
  const RawFrames frame = frame_of(noisy_pixels(setup.decoder.table(), 2e3, 1e4, 3000, 9), 10);
  const DepthImage expected = setup.decoder.decode(frame);
  for_each_target([&] {
    const DepthImage image = setup.decoder.decode(frame);
    EXPECT_EQ(image.depth_m.pixels, expected.depth_m.pixels);
    EXPECT_EQ(image.confidence.pixels, expected.confidence.pixels);
    EXPECT_EQ(image.predicted_standard_deviation_m.pixels,
              expected.predicted_standard_deviation_m.pixels);
    EXPECT_EQ(image.status.pixels, expected.status.pixels);
  });
}

TEST(Decoder, AgreesWithTheReferenceOnFineGrids) {
  Camera camera = camera_with("paper-10f0");
  camera.samples = 3000;
  const DecodeSetup setup("hamiltonian-k4", camera);
  expect_agreement(setup.decoder,
                   pixels_at_all_light_levels(setup.decoder.table(), pixels_per_level / 50), 397);
}

TEST(Decoder, AgreesWithTheReferenceAtAnyRank) {
  for (const char* code : {"hamiltonian-k6", "sinusoid-k8", "multifrequency-1x3-2x3-3x3-4x3"}) {
    const DecodeSetup setup(code, camera_with("paper-30x"));
    expect_agreement(setup.decoder,
                     pixels_at_all_light_levels(setup.decoder.table(), pixels_per_level / 50), 397);
  }
}

TEST(Decoder, AgreesWithTheReferenceOnTies) {
  // Small whole numbers tie often, and exactly.
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
