// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/multipath_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/shared/special_functions.hpp"

namespace tofsmith {

namespace {

// Limits relative to the main direction.
constexpr double min_direction = 1e-2;  // for separating returns
constexpr double min_kept = 1e-3;       // smaller directions contain only noise
constexpr int min_points = 900;

std::vector<float> as_floats(const RowMajorMatrix& values) {
  std::vector<float> floats;
  floats.reserve(static_cast<std::size_t>(values.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i)
    floats.push_back(static_cast<float>(values.data()[i]));
  return floats;
}

RowMajorMatrix closed(const RowMajorMatrix& table) {
  RowMajorMatrix rows(table.rows() + 1, table.cols());
  rows << table, table.row(0);
  return rows;
}

RowMajorMatrix thinned(const RowMajorMatrix& table, Eigen::Index rows) {
  RowMajorMatrix kept(rows, table.cols());
  for (Eigen::Index j = 0; j < rows; ++j) kept.row(j) = table.row(j * table.rows() / rows);
  return kept;
}

int coarse_places(const RowMajorMatrix& curve) {
  constexpr double max_turn = 0.165;  // relative to the length of the curve
  const double length = curve.norm();
  for (const int count : {80, 96, 120, 160, 200}) {
    if (count >= curve.rows()) break;
    const RowMajorMatrix rows = thinned(curve, count);
    double turn2 = 0.0;
    for (Eigen::Index j = 0; j < count; ++j)
      turn2 += (rows.row((j + 1) % count) - rows.row(j)).squaredNorm() *
               static_cast<double>(curve.rows()) / count;
    if (std::sqrt(turn2) < max_turn * length) return count;
  }
  return std::min(240, static_cast<int>(curve.rows()));
}

Eigen::VectorXd sizes_of_directions(const AmbientProjection& projection) {
  return projection.curve.colwise().norm();
}

}  // namespace

int independent_directions(const AmbientProjection& projection) {
  const Eigen::VectorXd size = sizes_of_directions(projection);
  return static_cast<int>((size.array() > min_direction * size.maxCoeff()).count());
}

RowMajorMatrix drawn_finer(const RowMajorMatrix& table, int factor) {
  const Eigen::Index rows = table.rows();
  const auto row = [&](Eigen::Index n) { return table.row((n + 2 * rows) % rows); };
  double chord_error = 0.0, cubic_error = 0.0;
  for (Eigen::Index n = 0; n < rows; ++n) {
    const Eigen::RowVectorXd chord = 0.5 * (row(n - 1) + row(n + 1));
    const Eigen::RowVectorXd cubic = 1.125 * chord - 0.0625 * (row(n - 3) + row(n + 3));
    chord_error += (row(n) - chord).squaredNorm();
    cubic_error += (row(n) - cubic).squaredNorm();
  }
  const bool by_chords = rows < 8 || chord_error <= cubic_error;
  RowMajorMatrix fine(rows * factor, table.cols());
  for (Eigen::Index n = 0; n < rows; ++n)
    for (Eigen::Index i = 0; i < factor; ++i) {
      const double t = static_cast<double>(i) / factor;
      if (by_chords)
        fine.row(n * factor + i) = (1 - t) * row(n) + t * row(n + 1);
      else
        fine.row(n * factor + i) =
            -t * (t - 1) * (t - 2) / 6 * row(n - 1) + (t + 1) * (t - 1) * (t - 2) / 2 * row(n) -
            (t + 1) * t * (t - 2) / 2 * row(n + 1) + (t + 1) * t * (t - 1) / 6 * row(n + 2);
    }
  return fine;
}

MultipathCurve::MultipathCurve(const DecodingTable& table, const AmbientProjection& projection,
                               double tail_m)
    : measurements(table.measurements()), sees_ambient(!projection.ambient.isZero(0.0)) {
  const Eigen::VectorXd size = sizes_of_directions(projection);
  span = std::min(max_span, static_cast<int>((size.array() > min_kept * size.maxCoeff()).count()));
  points_per_row = (min_points + table.samples() - 1) / table.samples();
  points = points_per_row * table.samples();

  const RowMajorMatrix curve = drawn_finer(projection.curve.leftCols(span), points_per_row);
  coarse = coarse_places(curve);
  fine = as_floats(closed(curve));
  coarse_row = as_floats(thinned(curve, coarse));
  if (tail_m > 0.0) {
    const RowMajorMatrix behind = exponential_average(curve, tail_m / table.range_m * points);
    tail = as_floats(closed(behind));
    coarse_tail = as_floats(thinned(behind, coarse));
  }

  RowMajorMatrix columns(measurements, dims());
  if (sees_ambient) columns.col(0) = projection.ambient.normalized();
  columns.rightCols(span) = projection.basis.leftCols(span);
  basis = as_floats(columns);
  RowMajorMatrix squares(measurements, pairs());
  for (Eigen::Index a = 0, at = 0; a < dims(); ++a)
    for (Eigen::Index b = 0; b <= a; ++b, ++at)
      squares.col(at) = columns.col(a).cwiseProduct(columns.col(b));
  products = as_floats(squares);
}

}  // namespace tofsmith
