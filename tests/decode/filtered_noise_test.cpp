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
    const RawFrames raw =
        frame_by_pixel(table.measurements(), side, side, seed,
                       [&](int y, int x, RandomStream& random, std::vector<float>& values) {
                         const double depth_bin = first_bin + 0.02 * x + 0.01 * y;
                         append_noisy_pixel(table, signal, 1e4,
                                            std::fmod(depth_bin, table.samples()), random, values);
                       });
    FilteredFrame filtered;
    filter.apply(view_of_frame(raw, 0), filtered);
    DepthImage image(side, side);
    image.residual = image.depth_m;
    setup.decoder.decode(filtered.view(), DecodedView::of(image));
    return image;
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

/// A slanted surface with stripes of albedo 12 pixels wide and a depth step.
RawFrames striped_frame(const DecodingTable& table) {
  return frame_by_pixel(table.measurements(), 96, 128, 7,
                        [&](int y, int x, RandomStream& random, std::vector<float>& raw) {
                          const double signal = x / 12 % 2 == 0 ? 3e4 : 1e4;
                          const double depth_bin = (y < 48 ? 60.0 : 110.0) + 0.05 * x;
                          append_noisy_pixel(table, signal, 1e4, depth_bin, random, raw);
                        });
}

TEST(MeasuredNoise, IsThatOfTheCameraOnScenesWithEdgesAndSlopes) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const RawFrames raw = striped_frame(table);
  const auto ratio = measured_noise_ratio(Filter(table), view_of_frame(raw, 0));
  ASSERT_TRUE(ratio.has_value());
  EXPECT_NEAR(*ratio, 1.0, 0.15);
}

TEST(MeasuredNoise, FindsThatTheCameraHasTheWrongNoise) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const RawFrames raw = striped_frame(table);
  RawView view = view_of_frame(raw, 0);
  const Image<float> averaged(96, 128, 25.0f);  // means would have a fifth of the noise
  view.averaged = averaged.pixels.data();
  const auto ratio = measured_noise_ratio(Filter(table), view);
  ASSERT_TRUE(ratio.has_value());
  EXPECT_NEAR(*ratio, 5.0, 0.75);
}

TEST(MeasuredNoise, IsUnknownInSmallFrames) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const RawFrames raw =
      frame_by_pixel(table.measurements(), 8, 8, 7,
                     [&](int, int, RandomStream& random, std::vector<float>& values) {
                       append_noisy_pixel(table, 1e4, 1e4, 60.0, random, values);
                     });
  EXPECT_FALSE(measured_noise_ratio(Filter(table), view_of_frame(raw, 0)).has_value());
}

}  // namespace

}  // namespace tofsmith
