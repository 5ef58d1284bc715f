// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// What a filter keeps of sums over near neighbours where it adds far ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "decode/filter/slope_kernel.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "tofsmith/decode/filter.hpp"

namespace tofsmith {
namespace {

/// Planes of near and far sums with a margin all round, rank 3 of 4 coordinates.
struct Sums {
  static constexpr int height = 9, width = 21, planes = 4, rank = 3;
  FilterGrid grid{.height = height, .width = width, .stride = 64, .margin = 16};
  static constexpr std::ptrdiff_t rows_above = 8, plane_floats = 64 * (height + 2 * rows_above);
  std::vector<float> storage = std::vector<float>((2 * planes + 5) * plane_floats, 0.0f);

  float* plane(int index) {
    return storage.data() + index * plane_floats + rows_above * grid.stride + grid.margin;
  }
  float* near(int k) { return plane(k); }
  float* far(int k) { return plane(planes + k); }
  float* usable() { return plane(2 * planes); }
  float* near_variance() { return plane(2 * planes + 1); }
  float* far_variance() { return plane(2 * planes + 2); }

  Sums() {
    RandomStream random(3, 0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::ptrdiff_t at = y * grid.stride + x;
        usable()[at] = (x + 3 * y) % 11 == 0 ? 0.0f : 1.0f;
        near_variance()[at] = static_cast<float>(1.0 + random.uniform());
        far_variance()[at] = static_cast<float>(0.1 + 1.2 * random.uniform());
        for (int k = 0; k < planes; ++k) {
          far(k)[at] = static_cast<float>(40.0 * (k + 1));
          const double apart = x < 10 ? 1.0 : 8.0;  // little beside the noise, and much
          near(k)[at] = static_cast<float>(70.0 * (k + 1) + apart * (random.uniform() - 0.5));
        }
      }
  }

  void keep() {
    NearAndFar sums{.planes = planes,
                    .rank = rank,
                    .usable = usable(),
                    .near_variance = near_variance(),
                    .far_variance = far_variance(),
                    .difference = plane(2 * planes + 3),
                    .kept = plane(2 * planes + 4)};
    for (std::size_t k = 0; k < planes; ++k)
      sums.near[k] = near(static_cast<int>(k)), sums.far[k] = far(static_cast<int>(k));
    for (int y = 0; y < height; ++y) compare_sums(sums, grid, y);
    for (int y = 0; y < height; ++y) keep_near(sums, grid, y);
  }

  /// Chi^2 of the two directions, in double.
  double difference(std::ptrdiff_t at) {
    double near2 = 0.0, far2 = 0.0, dot = 0.0;
    for (int k = 0; k < rank; ++k) {
      near2 += std::pow(near(k)[at], 2), far2 += std::pow(far(k)[at], 2);
      dot += double{near(k)[at]} * far(k)[at];
    }
    const double variance = near_variance()[at];
    return (near2 - dot * dot / far2) / std::max(variance - far_variance()[at], 0.25 * variance);
  }
};

TEST(FilterSums, NearSumsAreKeptAsTheReferenceSays) {
  for_each_target([] {
    Sums before, after;
    after.keep();
    bool some = false, none = false;
    for (int y = 0; y < Sums::height; ++y)
      for (int x = 0; x < Sums::width; ++x) {
        double chi2 = 0.0, count = 0.0;
        for (int dy = -4; dy <= 4; dy += 2)
          for (int dx = -4; dx <= 4; dx += 2) {
            const std::ptrdiff_t at = (y + dy) * before.grid.stride + x + dx;
            if (!(before.usable()[at] > 0.0f)) continue;
            chi2 += before.difference(at), ++count;
          }
        const double kept = std::max(0.0, 1.0 - 1.6 * (Sums::rank - 1) * count / chi2);
        (kept > 0.0 ? some : none) = true;
        const std::ptrdiff_t at = y * before.grid.stride + x;
        ASSERT_NEAR(after.plane(2 * Sums::planes + 4)[at], kept, 1e-3) << y << ' ' << x;
        for (int k = 0; k < Sums::planes; ++k)
          ASSERT_NEAR(after.far(k)[at],
                      before.far(k)[at] + kept * (before.near(k)[at] - before.far(k)[at]), 0.2)
              << y << ' ' << x;
        ASSERT_NEAR(after.far_variance()[at],
                    before.far_variance()[at] +
                        1.6 * kept * kept *
                            std::max(0.0f, before.near_variance()[at] - before.far_variance()[at]),
                    2e-3);
      }
    EXPECT_TRUE(some && none);
  });
}

TEST(FilterSums, InBrightLightSilhouettesOfBallsErrAtMostAQuarterMoreThanWithNearNeighboursAlone) {
  const DecodeSetup setup("hamiltonian-k5", camera_with("paper-10f0"));
  const DecodingTable& table = setup.decoder.table();
  const auto outside = [](int y, int x) { return std::hypot(y % 32 - 15.5, x % 32 - 15.5) / 13.0; };
  const auto depth = [&](int y, int x) {
    return 60.0 - 6.0 * std::sqrt(std::max(0.0, 1.0 - std::pow(outside(y, x), 2)));
  };
  const RawFrames raw =
      frame_by_pixel(table.measurements(), 96, 128, 1,
                     [&](int y, int x, RandomStream& random, std::vector<float>& values) {
                       const double signal = outside(y, x) < 1.0 ? 3e5 : 0.0;
                       append_noisy_pixel(table, signal, 1e4, depth(y, x), random, values);
                     });
  const auto mean_error = [&](const FilterOptions& options) {
    const FilteredFrame filtered = Filter(table, options).apply(raw);
    DepthImage image(96, 128);
    setup.decoder.decode(filtered.view(), DecodedView::of(image));
    double sum = 0.0, count = 0.0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 128; ++x)
        if (outside(y, x) < 1.0) {
          sum += std::abs(
              std::remainder(image.depth_m(y, x) / table.bin_m() - depth(y, x), table.samples()));
          ++count;
        }
    return sum / count;
  };
  FilterOptions near;
  near.windows = 1;
  const double with_far = mean_error({}), with_near = mean_error(near);
  RecordProperty("ratio", std::to_string(with_far / with_near));
  EXPECT_LE(with_far, 1.25 * with_near) << with_far << ' ' << with_near;
}

}  // namespace
}  // namespace tofsmith
