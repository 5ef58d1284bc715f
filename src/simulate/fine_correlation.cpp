// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/fine_correlation.hpp"

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

FineCorrelation::FineCorrelation(const ForwardModel& model)
    : FineCorrelation(model, model.straight_points_per_bin(least_points_per_bin)) {}

FineCorrelation::FineCorrelation(const ForwardModel& model, int points_per_bin)
    : FineCorrelation(
          (require(points_per_bin >= 1, "points_per_bin", points_per_bin, "must be >= 1"),
           model.has_rows()
               ? Eigen::MatrixXd(model.time_bin_table(model.samples() * points_per_bin))
               : model.tap_correlation_table(model.samples() * points_per_bin)),
          points_per_bin) {
  is_time_bin_ = model.has_rows();
  if (is_time_bin_) tap_values_ = model.samples();
}

FineCorrelation::FineCorrelation(const Eigen::MatrixXd& table, int points_per_bin)
    : tap_values_(static_cast<int>(table.cols())),
      points_(static_cast<int>(table.rows())),
      points_per_bin_(points_per_bin) {
  table_.reserve(static_cast<std::size_t>(points_ + 1) * static_cast<std::size_t>(tap_values_));
  for (int row = 0; row <= points_; ++row)
    for (int j = 0; j < tap_values_; ++j) table_.push_back(table(row % points_, j));
}

void FineCorrelation::at(double depth_bin, double* chi) const {
  const double position = depth_bin * points_per_bin_;
  const int cell = std::clamp(static_cast<int>(position), 0, points_ - 1);
  const double share = position - cell;
  if (is_time_bin_) {
    const int step = static_cast<int>(points_per_bin_);
    for (int n = 0, at = cell; n < tap_values_; ++n, at -= step) {
      if (at < 0) at += points_;
      const double* bin = table_.data() + at;
      chi[n] = bin[0] + share * (bin[1] - bin[0]);
    }
    return;
  }
  const double* below = table_.data() + static_cast<std::ptrdiff_t>(cell) * tap_values_;
  const double* above = below + tap_values_;
  for (int j = 0; j < tap_values_; ++j) chi[j] = below[j] + share * (above[j] - below[j]);
}

}  // namespace tofsmith
