// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/bin_matcher.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/shared/random.hpp"
#include "decode_setup.hpp"
#include "each_target.hpp"
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
    table.correlation = (curve * basis.transpose()).array() + 2.0;
    const auto every = [](double value) { return Eigen::VectorXd::Constant(measurements, value); };
    table.ambient_gain = table.exposure_s = table.gain_e_per_raw = every(1.0);
    table.dark_electrons = table.black_level = every(0.0);
    table.constant_variance_e2 = every(1.0);
    table.range_m = 1.0;
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

}  // namespace
}  // namespace tofsmith
