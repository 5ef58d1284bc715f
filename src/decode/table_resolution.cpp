// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/table_resolution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "decode/search/smooth_curve.hpp"

namespace tofsmith {

namespace {

constexpr int max_rows = 1 << 18;
/// Permitted error between rows: 20 um minus the rounding error of float.
double depth_accuracy_m(double range_m) {
  constexpr double in_all_m = 2e-5, least_m = 5e-6, margin = 0.8;
  return margin *
         std::max(least_m, in_all_m - 0.5 * range_m * std::numeric_limits<float>::epsilon());
}

constexpr double widest_turn_rad = 15.0 * std::numbers::pi / 180.0;

int resolving_factor(const DecodingTable& table) {
  const RowMajorMatrix curve = AmbientProjection(table).curve;
  if (curve.cols() < 2) return 1;
  const std::optional<SmoothCurve> smooth = SmoothCurve::of(curve);
  if (!smooth) return 1;
  const int most = std::max(1, max_rows / table.samples());
  const auto limited = [&](double factor) {
    return static_cast<int>(std::clamp(std::ceil(factor - 1e-9), 1.0, static_cast<double>(most)));
  };
  // The error is proportional to the cube of the spacing.
  const auto factor_of = [&](const SmoothCurve& at, double rows_per_row) {
    const double error_m = interpolation_error(at) * table.row_m() / rows_per_row;
    return rows_per_row * std::max(std::cbrt(error_m / depth_accuracy_m(table.range_m)),
                                   turns_of(at.points(0.0)).maxCoeff() / widest_turn_rad);
  };
  const double factor = factor_of(*smooth, 1.0);
  if (factor <= 1.0) return 1;
  // With few rows the estimate is unreliable.
  constexpr int finer = 4;
  const std::optional<SmoothCurve> fine = SmoothCurve::of(interpolated(curve, finer));
  return limited(fine ? factor_of(*fine, finer) : factor);
}

Eigen::MatrixXd on_chords(const Eigen::MatrixXd& columns, int factor) {
  Eigen::MatrixXd fine(columns.rows() * factor, columns.cols());
  for (Eigen::Index n = 0; n < columns.rows(); ++n)
    for (int i = 0; i < factor; ++i) {
      const double t = static_cast<double>(i) / factor;
      fine.row(n * factor + i) =
          (1 - t) * columns.row(n) + t * columns.row((n + 1) % columns.rows());
    }
  return fine;
}

}  // namespace

int sufficient_rows(const ForwardModel& model) {
  const int samples = model.samples();
  if (model.has_rows()) return samples;
  if (const std::optional<int> highest = model.highest_harmonic()) {
    const int factor = (8 * *highest + 3 * samples - 1) / (3 * samples);
    return samples * std::clamp(factor, 1, std::max(1, max_rows / samples));
  }
  constexpr int most = 32;
  for (int rows = samples; rows <= most * samples && rows <= max_rows; ++rows)
    if (model.has_corners_at_rows(rows)) return rows;
  return samples;
}

DecodingTable resolved(const DecodingTable& table) {
  constexpr int fewest_rows = 8;
  if (table.has_rows() || table.samples() < fewest_rows || !table.correlation.allFinite())
    return table;
  const int factor = resolving_factor(table);
  if (factor == 1) return table;
  DecodingTable fine = table;
  fine.bins = table.bin_count();
  fine.correlation = interpolated(table.correlation, factor);
  if (table.shot_correlation.size() > 0)
    fine.shot_correlation = on_chords(table.shot_correlation, factor);
  return fine;
}

}  // namespace tofsmith
