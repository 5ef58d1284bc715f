// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/likelihood/likelihood_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

namespace {

/// Minimum variance relative to the mean measurement.
constexpr double min_share = 1e-4;
double same_cost(double cost) { return 1e-10 * std::max(1.0, std::abs(cost)); }
constexpr int max_steps = 30, max_halvings = 8, max_chords = 16, max_bins_apart = 3;

}  // namespace

LikelihoodModel::LikelihoodModel(const DecodingTable& table, const AmbientProjection& projection)
    : samples_(table.samples()),
      measurements_(table.measurements()),
      unknowns_(projection.ambient.isZero(0.0) ? 2 : 3),
      ambient_(projection.ambient),
      gated_(projection.gated),
      noise_(table) {
  if (table.covariance.ambient.size() > 0) correlated_.emplace(table.covariance);
}

LikelihoodPixel LikelihoodModel::pixel(const double* electrons, double variance_share) const {
  double size = 0.0;
  for (int k = 0; k < measurements_; ++k) size += std::abs(electrons[k]);
  return {electrons, std::max(min_variance_e2, min_share * size / measurements_), variance_share};
}

double LikelihoodModel::cost(const LikelihoodPixel& pixel, std::int32_t bin,
                             const Quadratic::Vector& light) const {
  if (correlated_) return correlated_cost(pixel, bin, light);
  const std::int32_t to = next(bin);
  const double *x0 = gated_.row(bin).data(), *x1 = gated_.row(to).data();
  const double *s0 = noise_.shot_gated.row(bin).data(), *s1 = noise_.shot_gated.row(to).data();
  constexpr int factors = 4;  // the product of 4 variances does not overflow
  double squares = 0.0, logs = 0.0, product = 1.0;
  for (int k = 0; k < measurements_; ++k) {
    const double mean = light[0] * x0[k] + light[1] * x1[k] + light[2] * ambient_[k];
    const double variance = std::max(pixel.min_variance_e2, light[0] * s0[k] + light[1] * s1[k] +
                                                                light[2] * noise_.shot_ambient[k] +
                                                                noise_.floor_variance_e2[k]);
    const double residual = pixel.electrons[k] - mean;
    squares += residual * residual / (pixel.variance_share * variance);
    product *= variance;
    if (k % factors == factors - 1) {
      logs += std::log(product);
      product = 1.0;
    }
  }
  return squares + logs + std::log(product);
}

BoundedMinimum LikelihoodModel::least_squares(const LikelihoodPixel& pixel, std::int32_t bin,
                                              const double* weight) const {
  const double *x0 = gated_.row(bin).data(), *x1 = gated_.row(next(bin)).data();
  Quadratic q;
  for (int k = 0; k < measurements_; ++k) {
    const std::array mean{x0[k], x1[k], ambient_[k]};
    for (std::size_t i = 0; i < 3; ++i) {
      q.g[i] += weight[k] * pixel.electrons[k] * mean[i];
      for (std::size_t j = 0; j <= i; ++j) q.h[i][j] += weight[k] * mean[i] * mean[j];
    }
  }
  q.h[0][1] = q.h[1][0], q.h[0][2] = q.h[2][0], q.h[1][2] = q.h[2][1];
  return minimize_bounded(q, unknowns_);
}

/// Returns the quadratic approximation of cost / 2 with expected second derivatives (Fisher
/// scoring).
Quadratic LikelihoodModel::scoring(const LikelihoodPixel& pixel, std::int32_t bin,
                                   const Quadratic::Vector& light) const {
  if (correlated_) return correlated_scoring(pixel, bin, light);
  const std::int32_t to = next(bin);
  const double *x0 = gated_.row(bin).data(), *x1 = gated_.row(to).data();
  const double *s0 = noise_.shot_gated.row(bin).data(), *s1 = noise_.shot_gated.row(to).data();
  Quadratic q;
  for (int k = 0; k < measurements_; ++k) {
    const std::array mean{x0[k], x1[k], ambient_[k]};
    std::array shot{s0[k], s1[k], noise_.shot_ambient[k]};
    double residual = pixel.electrons[k], variance = noise_.floor_variance_e2[k];
    for (std::size_t i = 0; i < 3; ++i) {
      residual -= light[i] * mean[i];
      variance += light[i] * shot[i];
    }
    if (variance < pixel.min_variance_e2) {
      variance = pixel.min_variance_e2;
      shot = {};
    }
    for (double& by : shot) by *= pixel.variance_share;
    variance *= pixel.variance_share;
    const double by_mean = residual / variance;
    const double by_variance = 0.5 * (by_mean * by_mean - 1.0 / variance);
    for (std::size_t i = 0; i < 3; ++i) {
      q.g[i] += by_mean * mean[i] + by_variance * shot[i];
      for (std::size_t j = 0; j <= i; ++j)
        q.h[i][j] += mean[i] * mean[j] / variance + 0.5 * shot[i] * shot[j] / (variance * variance);
    }
  }
  q.h[0][1] = q.h[1][0], q.h[0][2] = q.h[2][0], q.h[1][2] = q.h[2][1];
  // Convert from steps to light.
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) q.g[i] += q.h[i][j] * light[j];
  return q;
}

double LikelihoodModel::correlated_cost(const LikelihoodPixel& pixel, std::int32_t bin,
                                        const Quadratic::Vector& light) const {
  const std::int32_t to = next(bin);
  CorrelatedNoise::Factor covariance;
  correlated_->at(bin, to, light, pixel.min_variance_e2, pixel.variance_share, covariance);
  const double *x0 = gated_.row(bin).data(), *x1 = gated_.row(to).data();
  CorrelatedNoise::Column residual;
  for (int k = 0; k < measurements_; ++k)
    residual[k] = pixel.electrons[k] - light[0] * x0[k] - light[1] * x1[k] - light[2] * ambient_[k];
  const double log_determinant = covariance.factorize(measurements_);
  covariance.whiten(measurements_, residual);
  // variance_share must not change the logarithms.
  return residual.head(measurements_).squaredNorm() + log_determinant -
         measurements_ * std::log(pixel.variance_share);
}

Quadratic LikelihoodModel::correlated_scoring(const LikelihoodPixel& pixel, std::int32_t bin,
                                              const Quadratic::Vector& light) const {
  const std::int32_t to = next(bin);
  CorrelatedNoise::Factor covariance;
  correlated_->at(bin, to, light, pixel.min_variance_e2, pixel.variance_share, covariance);
  covariance.factorize(measurements_);
  // In whitened coordinates, the covariance is the identity.
  const std::array rows{gated_.row(bin).data(), gated_.row(to).data(), ambient_.data()};
  std::array<CorrelatedNoise::Column, 3> mean;
  std::array<CorrelatedNoise::Matrix, 3> slope;
  CorrelatedNoise::Column residual;
  for (int k = 0; k < measurements_; ++k) residual[k] = pixel.electrons[k];
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < measurements_; ++k) {
      mean[i][k] = rows[i][k];
      residual[k] -= light[i] * rows[i][k];
    }
  covariance.whiten(measurements_, residual);
  for (std::size_t i = 0; i < 3; ++i) {
    covariance.whiten(measurements_, mean[i]);
    slope[i] = correlated_->slope(static_cast<int>(i), i == 0 ? bin : to, pixel.variance_share);
    covariance.whiten(measurements_, slope[i]);
  }
  const auto count = measurements_;
  const auto r = residual.head(count);
  Quadratic q;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto by = slope[i].topLeftCorner(count, count);
    q.g[i] = mean[i].head(count).dot(r) + 0.5 * (r.dot(by * r) - by.trace());
    for (std::size_t j = 0; j <= i; ++j)
      q.h[i][j] = q.h[j][i] = mean[i].head(count).dot(mean[j].head(count)) +
                              0.5 * by.cwiseProduct(slope[j].topLeftCorner(count, count)).sum();
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) q.g[i] += q.h[i][j] * light[j];
  return q;
}

ChordFit LikelihoodModel::fit(const LikelihoodPixel& pixel, std::int32_t bin,
                              const double* weight) const {
  ChordFit best{bin, least_squares(pixel, bin, weight).x};
  best.cost = cost(pixel, bin, best.light);
  for (int step = 0; step < max_steps; ++step) {
    const Quadratic::Vector aim = minimize_bounded(scoring(pixel, bin, best.light), unknowns_).x;
    double length = 1.0, fall = 0.0;
    for (int i = 0; i < max_halvings && !(fall > 0.0); ++i, length *= 0.5) {
      ChordFit tried = best;
      for (std::size_t j = 0; j < 3; ++j)
        tried.light[j] = length == 1.0 ? aim[j] : best.light[j] + length * (aim[j] - best.light[j]);
      tried.cost = cost(pixel, bin, tried.light);
      fall = best.cost - tried.cost;
      if (fall > 0.0) best = tried;
    }
    if (!(fall > same_cost(best.cost))) break;
  }
  return best;
}

ChordFit LikelihoodModel::fit_around(const LikelihoodPixel& pixel, std::int32_t bin,
                                     const double* weight) const {
  ChordFit best = fit(pixel, previous(bin), weight);
  const ChordFit after = fit(pixel, bin, weight);
  const bool upwards = after.cost < best.cost - same_cost(best.cost);
  if (upwards) best = after;
  for (int i = 0; i < max_chords; ++i) {
    if (upwards ? !best.is_at_next() : !best.is_at_bin()) break;
    const ChordFit beyond = fit(pixel, upwards ? next(best.bin) : previous(best.bin), weight);
    if (!(beyond.cost < best.cost - same_cost(best.cost))) break;
    best = beyond;
  }
  return best;
}

ChordFit LikelihoodModel::fit_near(const LikelihoodPixel& pixel, const ChordFit& found,
                                   const double* weight) const {
  ChordFit best = found;
  std::int32_t below = found.bin, above = found.bin;
  for (int distance = 1; distance <= max_bins_apart; ++distance) {
    below = previous(below), above = next(above);
    for (const std::int32_t bin : {below, above}) {
      const ChordFit other = fit(pixel, bin, weight);
      if (other.cost < best.cost - same_cost(best.cost)) best = other;
    }
  }
  return best;
}

PixelEstimate LikelihoodModel::estimate(const LikelihoodPixel& pixel, const ChordFit& fit) const {
  const std::int32_t from = fit.bin, to = next(from);
  const double signal = fit.signal_e_per_s(), t = fit.position().fraction;
  const double *x0 = gated_.row(from).data(), *x1 = gated_.row(to).data();
  const double *s0 = noise_.shot_gated.row(from).data(), *s1 = noise_.shot_gated.row(to).data();
  const double* before = gated_.row(previous(from)).data();
  const double* after = gated_.row(next(to)).data();
  constexpr int depth = 0, light = 1;
  // Per bin; at a bin, the mean of both sides.
  const auto slope_of = [&](int k) {
    return t <= 0.0   ? 0.5 * (x1[k] - before[k])
           : t >= 1.0 ? 0.5 * (after[k] - x0[k])
                      : x1[k] - x0[k];
  };
  Quadratic information;
  if (correlated_) {
    CorrelatedNoise::Factor covariance;
    correlated_->at(from, to, fit.light, pixel.min_variance_e2, pixel.variance_share, covariance);
    covariance.factorize(measurements_);
    std::array<CorrelatedNoise::Column, 3> by;
    for (int k = 0; k < measurements_; ++k) {
      by[0][k] = signal * slope_of(k);
      by[1][k] = (1 - t) * x0[k] + t * x1[k];
      by[2][k] = ambient_[k];
    }
    for (auto& column : by) covariance.whiten(measurements_, column);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        information.h[i][j] = by[i].head(measurements_).dot(by[j].head(measurements_));
  }
  for (int k = 0; k < measurements_ && !correlated_; ++k) {
    const double variance =
        std::max(pixel.min_variance_e2, fit.light[0] * s0[k] + fit.light[1] * s1[k] +
                                            fit.light[2] * noise_.shot_ambient[k] +
                                            noise_.floor_variance_e2[k]);
    const std::array by{signal * slope_of(k), (1 - t) * x0[k] + t * x1[k], ambient_[k]};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        information.h[i][j] += by[i] * by[j] / (pixel.variance_share * variance);
  }
  PixelEstimate result;
  result.signal_e_per_s = signal;
  result.ambient_e_per_s = unknowns_ == 3 ? fit.light[2] : std::numeric_limits<double>::quiet_NaN();
  result.signal_standard_deviation_e_per_s = 1.0 / std::sqrt(left_of(information, light));
  result.depth_standard_deviation_row = 1.0 / std::sqrt(left_of(information, depth));
  return result;
}

}  // namespace tofsmith
