// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Which values the kernel writes, and where.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "output_setup.hpp"

namespace tofsmith {
namespace {

TEST(OutputKernel, NamesPixelsWithoutDepth) {
  Camera camera = camera_with("paper-10f0");
  camera.sensor.full_well_e = 5000.0;
  const DecodeSetup setup("hamiltonian-k4", camera);
  const DecodingTable& table = setup.decoder.table();
  std::vector<float> raw = noisy_pixels(table, 1e4, 1e3, 40, 3);
  const auto set = [&raw](std::size_t pixel, const std::array<float, 4>& values) {
    std::copy(values.begin(), values.end(), raw.begin() + 4 * static_cast<std::ptrdiff_t>(pixel));
  };
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  set(3, {1.0f, nan, 2.0f, 3.0f});
  set(17, {infinity, 1.0f, 2.0f, 3.0f});
  set(18, {700.0f, 700.0f, 700.0f, 700.0f});
  set(19, {5000.0f, 5000.0f, 5000.0f, 5000.0f});
  set(20, {5000.0f, 100.0f, 200.0f, 300.0f});
  const Matched matched(table, raw);
  for_each_target([&] {
    const Outputs outputs = matched.outputs();
    EXPECT_EQ(outputs.status, matched.expected().status);
    EXPECT_EQ(outputs.bin, matched.expected().bin);
    EXPECT_EQ(outputs.status[3], PixelStatus::invalid);
    EXPECT_EQ(outputs.status[17], PixelStatus::invalid);
    EXPECT_EQ(outputs.status[18], PixelStatus::no_return);
    EXPECT_EQ(outputs.status[19], PixelStatus::saturated);
    EXPECT_EQ(outputs.status[20], PixelStatus::saturated);
    EXPECT_EQ(outputs.status[21], PixelStatus::ok);
    for (const std::size_t pixel : {3, 17, 18, 19})
      for (const auto* plane : {&outputs.depth_m, &outputs.signal, &outputs.ambient,
                                &outputs.confidence, &outputs.deviation_m})
        EXPECT_TRUE(std::isnan((*plane)[pixel])) << pixel;
    EXPECT_TRUE(std::isfinite(outputs.depth_m[20]));
  });
}

TEST(OutputKernel, HasAllStatuses) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-30x"));
  const DecodingTable& table = setup.decoder.table();
  const Outputs outputs = Matched(table, pixels_at_all_light_levels(table, 700)).outputs();
  for (const auto status : {PixelStatus::ok, PixelStatus::low_signal, PixelStatus::ambiguous})
    EXPECT_GT(std::count(outputs.status.begin(), outputs.status.end(), status), 20);
}

TEST(OutputKernel, WritesNothingPastATile) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  const std::vector<float> raw = noisy_pixels(setup.decoder.table(), 1e4, 1e4, pixels_per_tile, 4);
  const Outputs whole = Matched(setup.decoder.table(), raw).outputs();
  for (const std::size_t pixels : {0, 1, 3, 15, 16, 17, 63, 64, 127, 128, 129, 255}) {
    const Matched part(setup.decoder.table(),
                       {raw.begin(), raw.begin() + 3 * static_cast<std::ptrdiff_t>(pixels)});
    for_each_target([&] {
      Outputs outputs(tile_size), expected(tile_size);
      part.write(outputs.view());
      std::copy_n(whole.bin.begin(), pixels, expected.bin.begin());
      std::copy_n(whole.depth_m.begin(), pixels, expected.depth_m.begin());
      std::copy_n(whole.signal.begin(), pixels, expected.signal.begin());
      std::copy_n(whole.ambient.begin(), pixels, expected.ambient.begin());
      std::copy_n(whole.confidence.begin(), pixels, expected.confidence.begin());
      std::copy_n(whole.deviation_m.begin(), pixels, expected.deviation_m.begin());
      std::copy_n(whole.status.begin(), pixels, expected.status.begin());
      std::copy_n(whole.residual.begin(), pixels, expected.residual.begin());
      expect_same(outputs, expected);
    });
  }
}

TEST(OutputKernel, NeedsOnlyWhatThePlanesTake) {
  const DecodeSetup setup("hamiltonian-k3", camera_with("paper-30x"));
  const Matched matched(setup.decoder.table(),
                        noisy_pixels(setup.decoder.table(), 1e4, 1e4, 100, 6));
  std::vector<float> depth_m(100);
  const DecodedView planes{.depth_m = depth_m.data()};
  EXPECT_FALSE(matched.kernel().needs_electrons(planes));
  EXPECT_FALSE(matched.kernel().needs_confidence(planes));
  EXPECT_FALSE(matched.kernel().needs_saturation(planes));
  MatchedTile tile = matched.tile(0);
  tile.electrons = nullptr;
  tile.saturated = nullptr;
  matched.kernel().write(tile, planes);
  EXPECT_TRUE(same(depth_m, matched.outputs().depth_m));
}

TEST(OutputKernel, APlaneDoesNotDependOnWhichOthersAreWanted) {
  const DecodeSetup setup("hamiltonian-k4", camera_with("paper-10f0"));
  const Matched matched(setup.decoder.table(),
                        pixels_at_all_light_levels(setup.decoder.table(), 67));
  const Outputs all = matched.outputs();
  for (unsigned planes = 0; planes < 256; ++planes) {
    Outputs some(matched.pixels());
    matched.write(some.view(planes));
    SCOPED_TRACE(planes);
    expect_only(some, all, planes);
  }
}

TEST(OutputKernel, SaysTheSameOnEveryInstructionSet) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0", 2));
  const Matched matched(setup.decoder.table(),
                        pixels_at_all_light_levels(setup.decoder.table(), 300));
  const Outputs expected = matched.outputs();
  for_each_target([&] { expect_same(matched.outputs(), expected); });
}

}  // namespace
}  // namespace tofsmith
