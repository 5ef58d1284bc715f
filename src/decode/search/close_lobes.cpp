// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/close_lobes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr int max_lobes = 64;
/// Rows decide if the curve stays this many row spacings away from itself. The squared offsets of
/// rows from the best points then differ by less than 1 / 25 of the squared distance of the lobes.
constexpr double far_apart = 2.5;
constexpr Eigen::Index max_examined = 4096;

/// Returns true if the curve comes closer to itself than `distance`, except along the run of
/// decreasing scores around each row.
/// @param spacing  largest distance between neighbouring rows
bool comes_closer(const RowMajorMatrix& units, double distance, double spacing) {
  const Eigen::Index rows = units.rows();
  const Eigen::Index step = (rows + max_examined - 1) / max_examined;
  const double limit = 1.0 - 0.5 * distance * distance;
  for (Eigen::Index n = 0; n < rows; n += step) {
    const auto score = [&](Eigen::Index i) {
      return units.row(n).dot(units.row(i < rows ? i : i - rows));
    };
    // Follows the run to the first row at the distance. Returns true if the curve turns back first.
    Eigen::Index first = n + 1, last = n + rows - 1;
    const auto turns_back = [&](Eigen::Index& row, int direction) {
      double before = score(n);
      for (double now; first < last && (now = score(row)) > limit; row += direction, before = now)
        if (now > before) return true;
      return false;
    };
    if (turns_back(first, 1) || turns_back(last, -1)) return true;
    // Skip rows within which the curve cannot come close.
    while (first < last) {
      const double now = score(first);
      if (now > limit) return true;
      const double away = std::sqrt(std::max(0.0, 2.0 - 2.0 * now));
      first += std::max<Eigen::Index>(1, static_cast<Eigen::Index>((away - distance) / spacing));
    }
  }
  return false;
}

/// Maximum difference between the scores of a best point and of adjacent rows, relative to |q|.
double slack_of(const RowMajorMatrix& units) {
  const Eigen::Index rows = units.rows();
  double second_difference = 0.0;
  for (Eigen::Index n = 0; n < rows; ++n)
    second_difference = std::max(
        second_difference,
        (units.row((n + 1) % rows) - 2.0 * units.row(n) + units.row((n + rows - 1) % rows)).norm());
  constexpr double margin = 1.1;  // for the second derivative by differences
  return margin * second_difference / 8.0;
}

}  // namespace

std::optional<CloseLobes> CloseLobes::of(const AmbientProjection& projection) {
  // On a circle, intersecting lobes have the same shape; rows favour slowly passed lobes.
  if (projection.rank() < 3 || !depth_polynomials(projection.curve)) return std::nullopt;
  const RowMajorMatrix units = projection.curve.rowwise().normalized();
  const double spacing = turns_of(projection.curve).maxCoeff();
  if (!comes_closer(units, far_apart * spacing, spacing)) return std::nullopt;
  return CloseLobes(*SmoothCurve::of(projection.curve), slack_of(units));
}

CloseLobes::CloseLobes(const SmoothCurve& curve, double slack)
    : slack_(static_cast<float>(slack)),
      polynomials_(curve),
      points_(curve.points(0.0)),
      slopes_(curve.slopes(0.0)) {}

/// Score of the best point around a row, on the cubic through points and slopes of both rows.
double CloseLobes::best_score(const double* unit, std::int32_t row) const {
  using Vector = Eigen::Map<const Eigen::RowVectorXd>;
  const Vector q(unit, points_.cols());
  const double t = DepthPolynomials::maximum(q.dot(polynomials_.slope.row(row)),
                                             q.dot(polynomials_.bend.row(row)),
                                             q.dot(polynomials_.asymmetry.row(row)));
  const auto rows = static_cast<std::int32_t>(points_.rows());
  const std::int32_t from = t < 0.0 ? (row > 0 ? row - 1 : rows - 1) : row;
  const std::int32_t to = from + 1 < rows ? from + 1 : 0;
  const double s = t < 0.0 ? 1.0 + t : t;
  const double to_weight = s * s * (3.0 - 2.0 * s), slope_weight = s * (1.0 - s);
  const auto blend = [&](auto&& use) {
    return (1.0 - to_weight) * use(points_, from) + to_weight * use(points_, to) +
           slope_weight * ((1.0 - s) * use(slopes_, from) - s * use(slopes_, to));
  };
  double length2 = 0.0;
  for (Eigen::Index j = 0; j < points_.cols(); ++j) {
    const double p = blend([&](const RowMajorMatrix& m, std::int32_t n) { return m(n, j); });
    length2 += p * p;
  }
  const double along =
      blend([&](const RowMajorMatrix& m, std::int32_t n) { return q.dot(m.row(n)); });
  return along / std::sqrt(length2);
}

void CloseLobes::choose(const DirectionTable& directions, const ArcSearch& arcs,
                        PixelTile& tile) const {
  const int rank = directions.rank();
  std::array<std::int32_t, max_lobes> lobes;
  std::array<double, max_measurements> unit;
  std::array<float, max_measurements> unit_in_float;
  for (int i = 0; i < tile.pixels; ++i) {
    if (tile.bin[i] < 0) continue;
    double length2 = 0.0;
    for (int j = 0; j < rank; ++j) {
      const double q = tile.plane[j * pixels_per_tile + i];
      unit[static_cast<std::size_t>(j)] = q;
      length2 += q * q;
    }
    if (!(length2 > 0.0) || !std::isfinite(length2)) continue;
    for (int j = 0; j < rank; ++j) {
      unit[static_cast<std::size_t>(j)] /= std::sqrt(length2);
      unit_in_float[static_cast<std::size_t>(j)] =
          static_cast<float>(unit[static_cast<std::size_t>(j)]);
    }
    const int count = arcs.near_peaks(unit_in_float.data(), slack_, max_lobes, lobes.data());
    std::sort(lobes.begin(), lobes.begin() + count);
    double best = -1.0;
    std::int32_t chosen = tile.bin[i];
    for (int lobe = 0; lobe < count; ++lobe) {
      const std::int32_t row = lobes[static_cast<std::size_t>(lobe)];
      const double score = best_score(unit.data(), row);
      if (score > best + tie_tolerance) {
        best = score;
        chosen = row;
      }
    }
    // Single precision may shift a peak by one row.
    if (std::abs(circular_difference(chosen, tile.bin[i], directions.samples())) > 1)
      tile.bin[i] = chosen;
  }
}

}  // namespace tofsmith
