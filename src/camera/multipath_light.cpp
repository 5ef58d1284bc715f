// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/camera/forward_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/shared/periodic.hpp"
#include "core/shared/special_functions.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

/// Second integral of a histogram of total 1: 0 before it, quadratic within bins, linear after it.
class SecondIntegral {
 public:
  SecondIntegral(const std::vector<double>& light, double bin_rows) : bin_rows_(bin_rows) {
    const double total = std::accumulate(light.begin(), light.end(), 0.0);
    for (const double bin : light) {
      density_.push_back(bin / total / bin_rows);
      const double share = bin / total;
      once_.push_back(once_.back() + share);
      twice_.push_back(twice_.back() + bin_rows * (once_[once_.size() - 2] + 0.5 * share));
    }
  }
  double operator()(double row) const {
    if (row <= 0.0) return 0.0;
    const double end = bin_rows_ * static_cast<double>(density_.size());
    if (row >= end) return twice_.back() + (row - end);
    const std::size_t bin =
        std::min(static_cast<std::size_t>(row / bin_rows_), density_.size() - 1);
    const double within = row - bin_rows_ * static_cast<double>(bin);
    return twice_[bin] + within * (once_[bin] + 0.5 * within * density_[bin]);
  }

 private:
  double bin_rows_;
  std::vector<double> density_;                 // per row
  std::vector<double> once_{0.0}, twice_{0.0};  // at the start of each bin
};

/// Row weights whose correlation with a piecewise linear table equals the histogram's.
Eigen::VectorXd row_weights(const Transient& transient, double range_m, int points) {
  const double rows_per_m = points / range_m;
  const SecondIntegral integral(transient.light, rows_per_m * transient.bin_m);
  const double first = rows_per_m * transient.first_m;
  const double length = rows_per_m * transient.bin_m * static_cast<double>(transient.light.size());
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(points);
  const auto begin = static_cast<std::int64_t>(std::floor(first)) - 1;
  const auto end = static_cast<std::int64_t>(std::ceil(first + length)) + 1;
  for (std::int64_t row = begin; row <= end; ++row) {
    const double at = static_cast<double>(row) - first;
    // Histogram times a triangle of half width 1.
    weight[((row % points) + points) % points] +=
        integral(at + 1.0) - 2.0 * integral(at) + integral(at - 1.0);
  }
  return weight;
}

}  // namespace

void ExponentialTail::validate(double range_m) const {
  require(std::isfinite(mean_delay_m) && mean_delay_m > 0.0 && mean_delay_m <= range_m,
          "tail: mean_delay_m", mean_delay_m,
          "must be > 0 and at most the unambiguous range, " + fmt::format("{:f}", range_m) + " m");
  require(std::isfinite(ratio) && ratio >= 0.0, "tail: ratio", ratio, "must be finite and >= 0");
}

double Transient::total() const { return std::accumulate(light.begin(), light.end(), 0.0); }

std::vector<Return> Transient::returns(double depth_bin, double signal_e_per_s,
                                       double camera_bin_m) const {
  const double per_light = signal_e_per_s / total();
  std::vector<Return> all;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double behind_m = first_m + (static_cast<double>(i) + 0.5) * bin_m;
    if (light[i] > 0.0) all.push_back({per_light * light[i], depth_bin + behind_m / camera_bin_m});
  }
  return all;
}

void Transient::validate(double range_m) const {
  require(std::isfinite(bin_m) && bin_m > 0.0, "transient: bin_m", bin_m, "must be finite and > 0");
  require(std::isfinite(first_m), "transient: first_m", first_m, "must be finite");
  require(!light.empty(), "transient: bins", light.size(), "must be >= 1");
  for (std::size_t i = 0; i < light.size(); ++i)
    require(std::isfinite(light[i]) && light[i] >= 0.0, "transient: bin " + std::to_string(i),
            light[i], "must be finite and >= 0");
  require(total() > 0.0, "transient: light of all bins", total(), "must be > 0");
  const double length_m = bin_m * static_cast<double>(light.size());
  require(length_m <= range_m * (1.0 + 1e-9), "transient: length [m]", length_m,
          "must be at most the unambiguous range, " + fmt::format("{:f}", range_m) +
              " m; truncate it, or reduce the camera's fundamental_frequency_hz");
}

Eigen::MatrixXd tap_tail_table(const ForwardModel& model, const ExponentialTail& tail,
                               double range_m, int points) {
  tail.validate(range_m);
  return exponential_average(model.tap_correlation_table(points),
                             tail.mean_delay_m / range_m * points);
}

Eigen::MatrixXd tap_transient_table(const ForwardModel& model, const Transient& transient,
                                    double range_m, int points) {
  transient.validate(range_m);
  const Eigen::VectorXd weight = row_weights(transient, range_m, points);
  Eigen::MatrixXd table = model.tap_correlation_table(points);
  for (Eigen::Index i = 0; i < table.cols(); ++i)
    table.col(i) = circular_correlation(table.col(i), weight).eval();
  return table;
}

}  // namespace tofsmith
