// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/bin_matcher.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "core/shared/random.hpp"
#include "decode/ambient_projection.hpp"
#include "decode/search/tile_projection.hpp"
#include "decode/table_resolution.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
#include "random_codes.hpp"
#include "reference_decoder.hpp"

namespace tofsmith {

namespace {

/// K = 13 measurements whose curve spans `rank` dimensions, so that most of a pixel's noise does
/// not affect its depth.
struct CurveInFewDimensions {
  static constexpr int measurements = 13, samples = 300;
  explicit CurveInFewDimensions(int rank, RandomStream& random) {
    // Orthonormal columns; all but the first are orthogonal to ambient light.
    Eigen::MatrixXd any(measurements, rank + 2);
    for (double& value : any.reshaped()) value = random.normal();
    any.col(0).setOnes();
    const Eigen::MatrixXd axes = Eigen::HouseholderQR<Eigen::MatrixXd>(any).householderQ() *
                                 Eigen::MatrixXd::Identity(measurements, rank + 2);
    basis = axes.middleCols(1, rank);
    beside = axes.col(rank + 1);
    Eigen::MatrixXd curve(samples, rank);
    for (int n = 0; n < samples; ++n)
      for (int j = 0; j < rank; ++j)
        curve(n, j) = std::cos(2 * std::numbers::pi * (n * (j / 2 + 1.0) / samples - j % 2 * 0.25));
    direction = curve.rowwise().normalized();
    table = table_of_rows(((curve * basis.transpose()).array() + 2.0).matrix(), 1.0);
  }

  /// Returns a pixel between bins n and n + 1 with |P y'| = 100 `residual`, of which 100 lies in
  /// the plane of the curve; bin n + 1 leads by `lead` |P y'|.
  Eigen::VectorXd pixel(int n, double residual, double lead) const {
    const Eigen::RowVectorXd step = direction.row((n + 1) % samples) - direction.row(n);
    const Eigen::RowVectorXd middle = direction.row(n) + 0.5 * step;
    const Eigen::RowVectorXd unit =
        middle.normalized() + lead * residual / step.squaredNorm() * step;
    return (100 * (basis * unit.transpose() + std::sqrt(residual * residual - 1) * beside))
               .array() +
           1000.0;
  }

  Eigen::MatrixXd basis, direction;
  Eigen::VectorXd beside;
  DecodingTable table;
};

TEST(BinMatcher, ResolvesTiesToTheLowestBin) {
  RandomStream random(11, 0);
  for (const int rank : {2, 3, 4, 6}) {
    const CurveInFewDimensions curve(rank, random);
    const ReferenceDecoder reference(curve.table);
    const BinMatcher matcher(curve.table, AmbientProjection(curve.table));
    const auto tile = std::make_unique<PixelTile>();
    for (const double residual : {1.0, 4.0, 20.0, 60.0, 1000.0}) {
      std::vector<double> raw;
      std::vector<std::int32_t> expected;
      int ties = 0;
      for (int i = 0; i < pixels_per_tile; ++i) {
        const int n = static_cast<int>(random.uniform() * (curve.samples - 1));
        const double lead = std::array{5e-12, 2e-11, -5e-12, -2e-11}[i % 4];
        const Eigen::VectorXd y = curve.pixel(n, residual, lead);
        raw.insert(raw.end(), y.begin(), y.end());
        expected.push_back(reference.bin(y.data()));
        ties += i % 4 == 0 && expected.back() == n;
      }
      EXPECT_GE(ties, pixels_per_tile / 8) << "of rank " << rank;
      const RawView view = RawView::interleaved(raw.data(), 1, pixels_per_tile, curve.measurements);
      for_each_target([&](std::int64_t) {
        matcher.match(view, 0, pixels_per_tile, false, *tile);
        for (std::size_t i = 0; i < expected.size(); ++i)
          ASSERT_EQ(tile->bin[i], expected[i])
              << "pixel " << i << " of rank " << rank << ", residual " << residual;
      });
    }
  }
}

DecodingTable table_of(const std::string& code, double peak_factor) {
  Camera camera = built_in_camera("paper-10f0");
  camera.light.peak_factor = peak_factor;
  return decoding_table_of(code, camera);
}

DecodingTable rounded_otherwise(DecodingTable table) {
  RandomStream random(1, 0, 0);
  for (double& value : table.correlation.reshaped()) value *= 1.0 + 4e-16 * random.normal();
  return table;
}

// These curves are equally long in two directions of their space.
TEST(AmbientProjection, BasisOfTiedDirectionsIsRobustToRounding) {
  for (const auto& [code, peak] : {std::pair{"sinusoid-k4", 15.0},
                                   {"square-k4", 15.0},
                                   {"hamiltonian-k4", 6.0},
                                   {"hamiltonian-k4", 15.0},
                                   {"multifrequency-k5", 15.0}}) {
    SCOPED_TRACE(code);
    const DecodingTable table = table_of(code, peak);
    const AmbientProjection one(table), other(rounded_otherwise(table));
    ASSERT_EQ(one.rank(), other.rank());
    EXPECT_LT((one.noise_basis - other.noise_basis).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(AmbientProjection, BasisIsOrthonormalAndSpansTheCurve) {
  for (const char* code : {"sinusoid-k4", "hamiltonian-k4", "hamiltonian-k5"}) {
    SCOPED_TRACE(code);
    const AmbientProjection projection(table_of(code, 6.0));
    const Eigen::MatrixXd& v = projection.noise_basis;
    EXPECT_TRUE((v.transpose() * v).isIdentity(1e-12));
    EXPECT_LT((v.transpose() * projection.ambient).norm(), 1e-15 * projection.ambient.norm());
    const Eigen::VectorXd a = projection.ambient.normalized();
    const Eigen::MatrixXd across = projection.gated - (projection.gated * a) * a.transpose();
    EXPECT_LT((across - projection.curve * v.transpose()).norm(), 1e-12 * across.norm());
  }
}

// Rounding error bound of every projected pixel, compared with double arithmetic.

DecodingTable random_table(int measurements, bool is_equal, RandomStream& random) {
  DecodingTable table = random_table(RandomCode{measurements, 60, measurements - 1}, random);
  if (!is_equal) return table;
  for (Eigen::VectorXd* values :
       {&table.ambient_gain, &table.exposure_s, &table.dark_electrons, &table.constant_variance_e2,
        &table.black_level, &table.gain_e_per_raw})
    values->setConstant((*values)[0]);
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
