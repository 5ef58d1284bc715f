// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "decode_setup.hpp"
#include "each_target.hpp"
#include "output_setup.hpp"
#include "pixel_laws.hpp"
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
    ASSERT_GE(positions[i], 0.0);
    ASSERT_LT(positions[i], decoder.samples());
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
  bool has_equal_exposures = true;
};

class DecoderOfCode : public testing::TestWithParam<Case> {
 protected:
  static Camera camera_of_case() {
    const Case& c = GetParam();
    Camera camera = camera_with(c.camera, c.taps, c.readout);
    camera.samples = c.samples;
    if (!c.has_equal_exposures) camera.exposure_s.each_s = {0.02, 0.05, 0.1, 0.13};
    return camera;
  }
  void expect_agreement_on_every_pixel() const {
    const int samples = GetParam().samples;
    const int each = samples < 300 ? pixels_per_level : 1 + pixels_per_level * 60 / samples;
    std::vector<float> raw = pixels_at_all_light_levels(setup.decoder.table(), each);
    const std::vector<float> sunlit = noisy_pixels(setup.decoder.table(), 1e6, 1e8, each, 6);
    raw.insert(raw.end(), sunlit.begin(), sunlit.end());
    expect_agreement(setup.decoder, raw, 997);
  }

  DecodeSetup setup{GetParam().code, camera_of_case()};
};

TEST_P(DecoderOfCode, AgreesWithTheReferenceOnEveryPixel) { expect_agreement_on_every_pixel(); }

INSTANTIATE_TEST_SUITE_P(
    Codes, DecoderOfCode,
    testing::Values(Case{"hamiltonian-k3", "paper-30x"}, Case{"hamiltonian-k4", "paper-10f0"},
                    Case{"hamiltonian-k5", "paper-30x"}, Case{"sinusoid-k4", "paper-5f0"},
                    Case{"gray-k4", "paper-30x"}, Case{"multifrequency-k5", "paper-10f0"},
                    Case{"hamiltonian-k6", "paper-30x", 480},
                    Case{"hamiltonian-k3", "paper-30x", 1020},
                    Case{"hamiltonian-k4", "paper-10f0", 240, 2},
                    Case{"hamiltonian-k5", "paper-10f0", 240, 2, Readout::difference},
                    Case{"hamiltonian-k4", "paper-10f0", 240, 1, Readout::separate, false}));

class DecoderOfHighRankOrFineGrid : public DecoderOfCode {};

TEST_P(DecoderOfHighRankOrFineGrid, AgreesWithTheReferenceOnEveryPixel) {
  expect_agreement_on_every_pixel();
}

INSTANTIATE_TEST_SUITE_P(
    Codes, DecoderOfHighRankOrFineGrid,
    testing::Values(
        Case{"hamiltonian-k6", "paper-30x"}, Case{"sinusoid-k8", "paper-30x"},
        Case{"multifrequency-1x3-2x3-3x3-4x3", "paper-30x"},
        Case{"hamiltonian-k8", "paper-30x", 252}, Case{"hamiltonian-k4", "paper-10f0", 1020},
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

TEST(Decoder, PixelsWithoutReliableDepthAreMarked) {
  expect_statuses_of_bad_pixels<DecodeSetup>("hamiltonian-k4");
}

TEST(Decoder, AFaintPixelHasItsDepth) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  std::vector<float> raw;
  setup.append_expected(raw, 100.0, 30.0, 1e5);
  EXPECT_NEAR(decode_pixels(setup.decoder, raw).depth_m(0, 0), setup.camera.range_m() / 8, 1e-2);
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

struct NoiseCase {
  const char* code;
  int taps;
  Readout readout;
  double signal, ambient;
};

TEST(Decoder, EstimatesAgreeWithMonteCarloAtHighSignal) {
  for (const NoiseCase& c : {NoiseCase{"hamiltonian-k3", 1, Readout::separate, 1e5, 1e3},
                             NoiseCase{"hamiltonian-k4", 1, Readout::separate, 1e5, 1e5},
                             NoiseCase{"hamiltonian-k5", 1, Readout::separate, 1e6, 1e2},
                             NoiseCase{"sinusoid-k4", 1, Readout::separate, 1e5, 1e4},
                             NoiseCase{"hamiltonian-k4", 2, Readout::separate, 1e5, 1e4},
                             NoiseCase{"hamiltonian-k5", 2, Readout::difference, 1e5, 1e4}}) {
    SCOPED_TRACE(c.code);
    const DecodeSetup setup(c.code, camera_with("paper-10f0", c.taps, c.readout));
    for (const double truth_bin : {33.3, 121.7, 200.2}) {
      const PixelEstimates found = estimates_at(setup, truth_bin, c.signal, c.ambient);
      EXPECT_NEAR(found.ratio(), 1.0, 0.1) << truth_bin;
      EXPECT_NEAR(found.signal.mean(), c.signal,
                  4 * found.signal.standard_error() + 1e-3 * c.signal);
      if (c.readout == Readout::separate) {
        EXPECT_NEAR(found.ambient.mean(), c.ambient,
                    4 * found.ambient.standard_error() + 1e-3 * c.signal);
      } else {
        EXPECT_TRUE(std::isnan(found.ambient.mean()));
      }
    }
  }
}

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

TEST_P(DecoderOfCode, PlanesAgreeWithTheirDefinition) {
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

}  // namespace

}  // namespace tofsmith
