// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/shared/filter_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "decode_setup.hpp"
#include "tofsmith/core/statistics.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {

namespace {

// Confidence and residual of frames with anisotropic noise (NoiseRatios).

constexpr int side = 48;

class FilteredNoise : public testing::TestWithParam<std::tuple<FilterStrength, const char*>> {
 protected:
  DepthImage decode_plane(double signal, double first_bin, unsigned seed) const {
    const DecodingTable& table = setup.decoder.table();
    const auto plane = [&](int y, int x) {
      return Seen{std::fmod(first_bin + 0.02 * x + 0.01 * y, table.samples()), signal};
    };
    const RawFrames raw = frame_seen(table, side, side, plane, 1e4, seed);
    return decode_filtered(setup.decoder, filter.apply(raw));
  }

  DecodeSetup setup{std::get<1>(GetParam()), camera_with("paper-10f0")};
  Filter filter{setup.decoder.table(), FilterOptions::of(std::get<0>(GetParam()))};
};

TEST_P(FilteredNoise, HasAResidualOfAtMostAboutOne) {
  for (const double signal : {3e3, 1e4, 1e5}) {
    RunningStatistics residual, inconsistent;
    for (unsigned seed = 1; seed <= 16; ++seed) {
      const DepthImage image = decode_plane(signal, 40.3 + seed, seed);
      for (const float value : image.residual.pixels) residual.add(value);
      for (const PixelStatus status : image.status.pixels)
        inconsistent.add(status == PixelStatus::inconsistent);
    }
    EXPECT_GT(residual.mean(), 0.4) << signal;
    EXPECT_LT(residual.mean(), 1.15) << signal;
    EXPECT_LT(inconsistent.mean(), 2e-3) << signal;
  }
}

TEST_P(FilteredNoise, ConfidenceIsTheFractionOfCorrectDepths) {
  const DecodingTable& table = setup.decoder.table();
  RunningStatistics claimed, right;
  RandomStream random(3, 0);
  for (unsigned seed = 1; seed <= 600; ++seed) {
    const double signal = 30.0 * std::pow(300.0, random.uniform());
    const double first_bin = table.bin_count() * random.uniform();
    const DepthImage image = decode_plane(signal, first_bin, seed);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float confidence = image.confidence(y, x);
        if (!(confidence >= 0.7f && confidence < 0.999f)) continue;
        const double away =
            std::remainder(image.depth_m(y, x) / table.bin_m() - (first_bin + 0.02 * x + 0.01 * y),
                           table.bin_count());
        claimed.add(confidence);
        right.add(std::abs(away) < 0.05 * table.bin_count());
      }
  }
  ASSERT_GT(claimed.count(), 20000);
  EXPECT_NEAR(claimed.mean(), right.mean(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Filters, FilteredNoise,
                         testing::Combine(testing::Values(FilterStrength::light,
                                                          FilterStrength::normal,
                                                          FilterStrength::strong),
                                          testing::Values("hamiltonian-k5", "sinusoid-k5")),
                         [](const auto& info) {
                           std::string name = std::string(name_of(std::get<0>(info.param))) + "_" +
                                              std::get<1>(info.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Noise measured in the frame.

TEST(MeasuredNoise, IsThatOfTheCameraOnScenesWithEdgesAndSlopes) {
  const DecodingTable table = decoding_table_of("hamiltonian-k4", camera_with("paper-10f0"));
  const Filter filter(table);
  // A slanted surface with stripes of albedo 12 pixels wide and a depth step.
  const auto stripes = [](int y, int x) {
    return Seen{(y < 48 ? 60.0 : 110.0) + 0.05 * x, x / 12 % 2 == 0 ? 3e4 : 1e4};
  };
  const RawFrames raw = frame_seen(table, 96, 128, stripes, 1e4, 7);
  RawView view = view_of_frame(raw, 0);
  const auto ratio = measured_noise_ratio(filter, view);
  ASSERT_TRUE(ratio.has_value());
  EXPECT_NEAR(*ratio, 1.0, 0.15);
  const Image<float> averaged(96, 128, 25.0f);  // means would have a fifth of the noise
  view.averaged = averaged.pixels.data();
  const auto of_means = measured_noise_ratio(filter, view);
  ASSERT_TRUE(of_means.has_value());
  EXPECT_NEAR(*of_means, 5.0, 0.75);
}

TEST(MeasuredNoise, IsUnknownInSmallFrames) {
  const DecodingTable table = decoding_table_of("hamiltonian-k4", camera_with("paper-10f0"));
  const RawFrames raw = frame_seen(table, 8, 8, [](int, int) { return Seen{60.0, 1e4}; });
  EXPECT_FALSE(measured_noise_ratio(Filter(table), view_of_frame(raw, 0)).has_value());
}

}  // namespace

}  // namespace tofsmith
