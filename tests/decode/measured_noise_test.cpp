// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/filter/shared/measured_noise.hpp"

#include <gtest/gtest.h>

#include "decode_setup.hpp"

namespace tofsmith {
namespace {

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
