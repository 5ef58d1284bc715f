// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// Rounding error bound of every projected pixel, compared with double arithmetic.
#include "decode/search/tile_projection.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/shared/random.hpp"
#include "decode/search/exact_projection.hpp"
#include "each_target.hpp"

namespace tofsmith {
namespace {

DecodingTable random_table(int measurements, bool is_equal, RandomStream& random) {
  DecodingTable table;
  table.correlation = Eigen::MatrixXd(60, measurements);
  for (double& value : table.correlation.reshaped()) value = random.uniform();
  const auto about = [&](double value) {
    Eigen::VectorXd v(measurements);
    for (double& x : v) x = is_equal ? value : value * (0.5 + random.uniform());
    return v;
  };
  table.ambient_gain = about(0.5);
  table.exposure_s = about(0.01);
  table.dark_electrons = about(30.0);
  table.constant_variance_e2 = about(100.0);
  table.black_level = about(64.0);
  table.gain_e_per_raw = about(3.0);
  table.range_m = 10.0;
  return table;
}

/// Raw values with ambient light of up to 1e5 times the residual.
template <typename Number>
std::vector<Number> random_raw(const DecodingTable& table, int pixels, RandomStream& random) {
  std::vector<Number> raw;
  for (int i = 0; i < pixels; ++i) {
    const double ambient = std::pow(10.0, 5.0 * random.uniform());
    for (int k = 0; k < table.measurements(); ++k)
      raw.push_back(static_cast<Number>(
          table.black_level[k] +
          (ambient * table.exposure_s[k] * table.ambient_gain[k] * 100 + random.normal()) /
              table.gain_e_per_raw[k]));
  }
  return raw;
}

template <typename Number>
void expect_bounds(const DecodingTable& table, RandomStream& random) {
  const AmbientProjection ambient(table);
  const TileProjection projection(table, ambient, 1.0);
  const ExactProjection exact(table, ambient);
  constexpr int pixels = 200;
  const std::vector<Number> raw = random_raw<Number>(table, pixels, random);
  const RawView view = RawView::interleaved(raw.data(), 1, pixels, table.measurements());
  for_each_target([&](std::int64_t) {
    for (const bool for_outputs : {false, true}) {
      const auto tile = std::make_unique<PixelTile>();
      projection.project(view, 0, pixels, for_outputs, *tile);
      for (int i = 0; i < pixels; ++i) {
        std::array<double, max_measurements> numbers;
        for (int k = 0; k < table.measurements(); ++k)
          numbers[static_cast<std::size_t>(k)] =
              static_cast<double>(raw[static_cast<std::size_t>(i * table.measurements() + k)]);
        PlaneVector vector;
        exact.project(numbers.data(), vector);
        double square = 0.0;
        for (int j = 0; j < exact.rank(); ++j) {
          const double off = tile->plane[j * pixels_per_tile + i] -
                             vector.unit[static_cast<std::size_t>(j)] * vector.length;
          square += off * off;
        }
        ASSERT_LE(std::sqrt(square), tile->error[i]) << "pixel " << i;
      }
    }
  });
}

TEST(TileProjection, BoundsTheRoundingError) {
  RandomStream random(1, 0);
  for (const int measurements : {3, 4, 5, 6, 8, 11})
    for (const bool is_equal : {true, false}) {
      const DecodingTable table = random_table(measurements, is_equal, random);
      expect_bounds<float>(table, random);
      expect_bounds<double>(table, random);
    }
}

TEST(TileProjection, IsAccurateUnderEqualAmbientLight) {
  RandomStream random(2, 0);
  const DecodingTable table = random_table(4, true, random);
  const TileProjection projection(table, AmbientProjection(table), 1.0);
  // A signal of 100 under ambient light of 1e6 would lose 0.1 in plain single precision.
  const std::vector<float> raw = {1e6f + 100, 1e6f, 1e6f, 1e6f};
  const auto tile = std::make_unique<PixelTile>();
  projection.project(RawView::interleaved(raw.data(), 1, 1, 4), 0, 1, false, *tile);
  EXPECT_LT(tile->error[0], 1e-3f);
}

}  // namespace
}  // namespace tofsmith
