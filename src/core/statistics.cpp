// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

Estimate ratio_of(const Estimate& a, const Estimate& b) {
  const double ratio = a.value / b.value;
  return {ratio, ratio * std::hypot(a.standard_error / a.value, b.standard_error / b.value)};
}

void RunningStatistics::add(double value) {
  ++count_;
  const double difference = value - mean_;
  mean_ += difference / static_cast<double>(count_);
  sum_of_squares_ += difference * (value - mean_);
}

double RunningStatistics::variance() const {
  return count_ < 2 ? 0.0 : sum_of_squares_ / static_cast<double>(count_ - 1);
}

double RunningStatistics::standard_error() const {
  return count_ < 2 ? 0.0 : std::sqrt(variance() / static_cast<double>(count_));
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double quantile_of(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Estimate mean_of(std::span<const Estimate> estimates) {
  Estimate mean;
  if (estimates.empty()) return mean;
  double variance = 0.0;
  for (const Estimate& e : estimates) {
    mean.value += e.value;
    variance += e.standard_error * e.standard_error;
  }
  const double count = static_cast<double>(estimates.size());
  return {mean.value / count, std::sqrt(variance) / count};
}

Estimate geometric_mean_of(std::span<const Estimate> estimates) {
  if (estimates.empty()) return {};
  double log_sum = 0.0, relative_variance = 0.0;
  for (const Estimate& e : estimates) {
    if (std::isnan(e.value)) return {e.value, e.value};
    if (!(e.value > 0.0)) return {};
    log_sum += std::log(e.value);
    const double relative = e.standard_error / e.value;
    relative_variance += relative * relative;
  }
  const double count = static_cast<double>(estimates.size());
  const double value = std::exp(log_sum / count);
  return {value, value * std::sqrt(relative_variance) / count};
}

}  // namespace tofsmith
