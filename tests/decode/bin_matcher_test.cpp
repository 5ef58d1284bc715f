// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The second peaks that confidence compares with, against a search of all bins.
#include "decode/search/bin_matcher.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "decode_setup.hpp"

namespace tofsmith {
namespace {

struct Case {
  const char* code;
  std::vector<double> exposures_s;
  double signal, ambient;
};

void expect_second_peaks(const Case& c) {
  Camera camera = camera_with("paper-10f0");
  camera.exposure_s.each_s = c.exposures_s;
  const DecodeSetup setup(c.code, camera);
  const DecodingTable& table = setup.decoder.table();
  const AmbientProjection projection(table);
  const DirectionTable directions(projection);
  const BinMatcher matcher(table, projection);
  constexpr int pixels = 2000;
  const std::vector<float> raw = noisy_pixels(table, c.signal, c.ambient, pixels, 5);
  const RawView view = RawView::interleaved(raw.data(), 1, pixels, table.measurements());
  const auto tile = std::make_unique<PixelTile>();
  int close = 0, seen = 0;
  for (int first = 0; first + pixels_per_tile <= pixels; first += pixels_per_tile) {
    matcher.match(view, first, pixels_per_tile, true, *tile);
    matcher.find_second_peaks(*tile);
    for (int i = 0; i < pixels_per_tile; ++i) {
      const Lobe lobe = directions.main_lobe(tile->bin[i]);
      const auto score = [&](std::int32_t bin) {
        double sum = 0.0;
        for (int j = 0; j < directions.rank(); ++j)
          sum += directions.direction(bin, j) * tile->plane[j * pixels_per_tile + i];
        return sum;
      };
      if (lobe.end - lobe.begin >= table.samples()) {
        ASSERT_EQ(tile->second_peak[i], -1);
        continue;
      }
      std::int32_t best = -1;
      for (std::int32_t n = lobe.end; n < lobe.begin + table.samples(); ++n)
        if (best < 0 || score(n % table.samples()) > score(best)) best = n % table.samples();
      const std::int32_t second_peak = tile->second_peak[i];
      ASSERT_GE(second_peak, 0);
      const std::int32_t after = (second_peak - lobe.begin + table.samples()) % table.samples();
      ASSERT_GE(after, lobe.end - lobe.begin) << "inside the main lobe";
      double length2 = 0.0;
      for (int j = 0; j < directions.rank(); ++j) {
        const double q = tile->plane[j * pixels_per_tile + i];
        length2 += q * q;
      }
      ++seen;
      if (score(best) - score(second_peak) <= 0.02 * std::sqrt(length2)) ++close;
    }
  }
  EXPECT_GE(close, static_cast<int>(0.98 * seen)) << c.code;
}

TEST(BinMatcher, FindsRivalsOutsideTheMainLobe) {
  for (const Case& c :
       {Case{"hamiltonian-k4", {}, 3e3, 1e4}, Case{"hamiltonian-k5", {}, 3e3, 1e4},
        Case{"multifrequency-k5", {}, 1e4, 1e4}, Case{"hamiltonian-k6", {}, 3e3, 1e4}})
    expect_second_peaks(c);
}

TEST(BinMatcher, FindsRivalsOfPixelsThatDoubleArithmeticDecides) {
  // With unequal exposures, bright ambient light leaves single precision unsure.
  expect_second_peaks({"multifrequency-k5", {0.02, 0.05, 0.1, 0.13, 0.08}, 1e3, 1e7});
  expect_second_peaks({"hamiltonian-k4", {0.02, 0.05, 0.1, 0.13}, 1e3, 1e7});
}

TEST(BinMatcher, FindsTheSameBinsForFewPixelsAsForMany) {
  const Camera camera = camera_with("paper-10f0");
  for (const char* code : {"hamiltonian-k4", "hamiltonian-k5"}) {
    const DecodeSetup setup(code, camera);
    const DecodingTable& table = setup.decoder.table();
    const AmbientProjection projection(table);
    const BinMatcher of_many(table, projection), of_few(table, projection, true);
    constexpr int pixels = 40 * pixels_per_tile;
    const std::vector<float> raw = noisy_pixels(table, 3e3, 1e4, pixels, 7);
    const RawView view = RawView::interleaved(raw.data(), 1, pixels, table.measurements());
    const auto many = std::make_unique<PixelTile>(), few = std::make_unique<PixelTile>();
    for (int first = 0; first < pixels; first += pixels_per_tile) {
      of_many.match(view, first, pixels_per_tile, false, *many);
      of_few.match(view, first, pixels_per_tile, false, *few);
      for (int i = 0; i < pixels_per_tile; ++i) ASSERT_EQ(many->bin[i], few->bin[i]) << code;
    }
  }
}

}  // namespace
}  // namespace tofsmith
