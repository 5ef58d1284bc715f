// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/likelihood/correlated_noise.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

CorrelatedNoise::CorrelatedNoise(const RowCovariance& covariance)
    : measurements_(static_cast<int>(covariance.at(0, 0.0, 0.0).rows())),
      signal_(covariance.signal),
      ambient_(covariance.ambient),
      floor_(covariance.floor) {}

double CorrelatedNoise::Factor::factorize(int count) {
  // Directions with a smaller relative variance have no noise.
  constexpr double least_share = 1e-12;
  double log_determinant = 0.0;
  for (int j = 0; j < count; ++j) {
    const double whole = values(j, j);
    const double left = std::max(whole - values.row(j).head(j).squaredNorm(), least_share * whole);
    log_determinant += std::log(left);
    const double diagonal = values(j, j) = std::sqrt(left);
    for (int i = j + 1; i < count; ++i)
      values(i, j) = (values(i, j) - values.row(i).head(j).dot(values.row(j).head(j))) / diagonal;
  }
  return log_determinant;
}

void CorrelatedNoise::Factor::whiten(int count, Column& column) const {
  for (int i = 0; i < count; ++i) {
    double value = column[i];
    for (int j = 0; j < i; ++j) value -= values(i, j) * column[j];
    column[i] = value / values(i, i);
  }
}

void CorrelatedNoise::Factor::whiten(int count, Matrix& matrix) const {
  Column column;
  for (const bool transposed : {false, true})
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) column[i] = transposed ? matrix(j, i) : matrix(i, j);
      whiten(count, column);
      for (int i = 0; i < count; ++i) (transposed ? matrix(j, i) : matrix(i, j)) = column[i];
    }
}

void CorrelatedNoise::at(std::int32_t bin, std::int32_t next, const Quadratic::Vector& light,
                         double min_variance_e2, double variance_share, Factor& covariance) const {
  const double *s0 = signal_.row(bin).data(), *s1 = signal_.row(next).data();
  covariance.values.resize(measurements_, measurements_);
  for (int i = 0, pair = 0; i < measurements_; ++i)
    for (int j = 0; j <= i; ++j, ++pair) {
      double value =
          light[0] * s0[pair] + light[1] * s1[pair] + light[2] * ambient_[pair] + floor_[pair];
      if (i == j) value = std::max(value, min_variance_e2);
      covariance.values(i, j) = variance_share * value;
    }
}

CorrelatedNoise::Matrix CorrelatedNoise::slope(int light, std::int32_t bin,
                                               double variance_share) const {
  Matrix slope(measurements_, measurements_);
  const double* packed = light == 2 ? ambient_.data() : signal_.row(bin).data();
  for (int i = 0, pair = 0; i < measurements_; ++i)
    for (int j = 0; j <= i; ++j, ++pair) slope(i, j) = slope(j, i) = variance_share * packed[pair];
  return slope;
}

}  // namespace tofsmith
