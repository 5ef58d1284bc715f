// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/noise_metric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tofsmith {

NoiseMetric::NoiseMetric(const RowMajorMatrix& noise_basis, const double* plane,
                         const double* variance_e2)
    : rank_(static_cast<int>(noise_basis.cols())) {
  // Smaller relative variances are rounding errors of noiseless directions.
  constexpr double least_share = 1e-12;
  std::array<double, max_pairs> factor;
  const auto at = [](int i, int j) { return static_cast<std::size_t>(i * (i + 1) / 2 + j); };
  for (int i = 0; i < rank_; ++i)
    for (int j = 0; j <= i; ++j) factor[at(i, j)] = 0.0;
  for (int k = 0; k < static_cast<int>(noise_basis.rows()); ++k) {
    const double* const row = noise_basis.row(k).data();
    for (int i = 0; i < rank_; ++i) {
      const double by = variance_e2[k] * row[i];
      for (int j = 0; j <= i; ++j) factor[at(i, j)] += by * row[j];
    }
  }
  // C = L L^T; the diagonal stores inverses.
  for (int j = 0; j < rank_; ++j) {
    double left = factor[at(j, j)];
    const double floor = least_share * left;
    for (int k = 0; k < j; ++k) left -= factor[at(j, k)] * factor[at(j, k)];
    const double inverse = factor[at(j, j)] = 1.0 / std::sqrt(std::max(left, floor));
    for (int i = j + 1; i < rank_; ++i) {
      double value = factor[at(i, j)];
      for (int k = 0; k < j; ++k) value -= factor[at(i, k)] * factor[at(j, k)];
      factor[at(i, j)] = value * inverse;
    }
  }
  // L^-1 in place
  for (int j = 0; j < rank_; ++j)
    for (int i = j + 1; i < rank_; ++i) {
      double value = factor[at(i, j)] * factor[at(j, j)];
      for (int k = j + 1; k < i; ++k) value += factor[at(i, k)] * factor[at(k, j)];
      factor[at(i, j)] = -value * factor[at(i, i)];
    }
  for (int i = 0; i < rank_; ++i) {
    along_[static_cast<std::size_t>(i)] = 0.0;
    for (int j = 0; j <= i; ++j) {
      double value = 0.0;
      for (int k = i; k < rank_; ++k) value += factor[at(k, i)] * factor[at(k, j)];
      metric_[at(i, j)] = value;
    }
  }
  double square = 0.0;
  for (int i = 0; i < rank_; ++i) {
    double white = 0.0;
    for (int j = 0; j <= i; ++j) white += factor[at(i, j)] * plane[j];
    square += white * white;
    for (int j = 0; j <= i; ++j) along_[static_cast<std::size_t>(j)] += factor[at(i, j)] * white;
  }
  length_ = std::sqrt(square);
}

/// Eigenvalues differ from the mean by at most sqrt(rank - 1) standard deviations.
double NoiseMetric::stretch() const {
  double trace = 0.0, squares = 0.0;
  for (int i = 0, at = 0; i < rank_; ++i)
    for (int j = 0; j <= i; ++j, ++at) {
      const double value = metric_[static_cast<std::size_t>(at)];
      if (i == j) trace += value;
      squares += (i == j ? 1.0 : 2.0) * value * value;
    }
  const double mean = trace / rank_;
  const double reach = std::sqrt((rank_ - 1) * std::max(0.0, squares / rank_ - mean * mean));
  return mean > reach ? std::sqrt((mean + reach) / (mean - reach))
                      : std::numeric_limits<double>::infinity();
}

double NoiseMetric::product(const double* u, const double* w) const {
  double sum = 0.0;
  for (int i = 0, at = 0; i < rank_; ++i)
    for (int j = 0; j <= i; ++j, ++at)
      sum += metric_[static_cast<std::size_t>(at)] *
             (i == j ? u[i] * w[i] : u[i] * w[j] + u[j] * w[i]);
  return sum;
}

double NoiseMetric::signal(const double* u) const {
  double sum = 0.0;
  for (int i = 0; i < rank_; ++i) sum += along_[static_cast<std::size_t>(i)] * u[i];
  return sum;
}

}  // namespace tofsmith
