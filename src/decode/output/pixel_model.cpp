// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/pixel_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/shared/decompositions.hpp"
#include "core/shared/special_functions.hpp"
#include "decode/output/output_chunk.hpp"
#include "tofsmith/core/parallel.hpp"

namespace tofsmith {

namespace {

double dot(const double* a, const double* b, int size) {
  double sum = 0.0;
  for (int i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

PixelModel::PixelModel(const DecodingTable& table, const AmbientProjection& projection)
    : samples_(table.samples()),
      projection_(projection),
      polynomials_(depth_polynomials(projection.curve)),
      basis_(projection.basis),
      noise_basis_(projection.noise_basis),
      noise_(table) {
  own_ = projection.curve.rowwise().squaredNorm();
  with_next_.resize(samples_);
  for (std::int32_t n = 0; n < samples_; ++n)
    with_next_[n] = projection.curve.row(n).dot(projection.curve.row(next(n)));
}

void PixelModel::project(const double* electrons, double* plane) const {
  const int r = rank();
  std::fill_n(plane, r, 0.0);
  double size = 0.0;
  for (int k = 0; k < measurements(); ++k) {
    size += std::abs(electrons[k]);
    for (int j = 0; j < r; ++j) plane[j] += basis_(k, j) * electrons[k];
  }
  if (std::sqrt(dot(plane, plane, r)) <= nothing_left * size) std::fill_n(plane, r, 0.0);
}

double PixelModel::along(const double* plane, std::int32_t bin) const {
  return dot(plane, projection_.curve.row(bin).data(), rank());
}

PixelModel::ChordPoint PixelModel::best_inside(std::int32_t bin, double at_bin,
                                               double at_next) const {
  const double q00 = own_[bin], q11 = own_[next(bin)], q01 = with_next_[bin];
  if (q00 * q11 - q01 * q01 <= parallel_chords * q00 * q11) return {};
  const double u = q11 * at_bin - q01 * at_next;
  const double v = q00 * at_next - q01 * at_bin;
  if (!(u > 0.0 && v > 0.0)) return {};
  const double t = v / (u + v);
  const double length2 = (1 - t) * (1 - t) * q00 + 2 * t * (1 - t) * q01 + t * t * q11;
  return {t, ((1 - t) * at_bin + t * at_next) / std::sqrt(length2)};
}

PixelModel::Rise PixelModel::rise_at(const double* plane, std::int32_t row) const {
  return {dot(plane, polynomials_->slope.row(row).data(), rank()),
          dot(plane, polynomials_->bend.row(row).data(), rank()),
          dot(plane, polynomials_->asymmetry.row(row).data(), rank())};
}

double PixelModel::signal_on_curve(const double* plane, const Position& position) const {
  const bool is_near = position.fraction < 0.5;
  const std::int32_t row = is_near ? position.bin : next(position.bin);
  const double t = is_near ? position.fraction : position.fraction - 1.0;
  const auto [g, b, c] = rise_at(plane, row);
  return (along(plane, row) / own_[row] + t * (g + t * (b / 2 + t * c / 3))) /
         (1.0 + t * (polynomials_->growth[row] + t * polynomials_->growth_change[row]));
}

Position PixelModel::refine(const double* plane, std::int32_t bin) const {
  if (polynomials_) {
    const auto [g, b, c] = rise_at(plane, bin);
    const double t = DepthPolynomials::maximum(g, b, c);
    if (t >= 1.0) return {next(bin), 0.0};
    return t < 0.0 ? Position{previous(bin), 1.0 + t} : Position{bin, t};
  }
  const std::int32_t left = previous(bin);
  const double at_bin = along(plane, bin);
  const ChordPoint before = best_inside(left, along(plane, left), at_bin);
  const ChordPoint after = best_inside(bin, at_bin, along(plane, next(bin)));
  if (!(before.score > 0.0 || after.score > 0.0)) return {bin, 0.0};
  if (before.score >= (1 - tie_tolerance) * after.score) return {left, before.fraction};
  return {bin, after.fraction};
}

double PixelModel::score_at(const double* plane, std::int32_t row) const {
  return own_[row] > 0.0 ? along(plane, row) / std::sqrt(own_[row])
                         : -std::numeric_limits<double>::infinity();
}

/// On a smooth curve, the score is that of the nearest row plus the integral of its slope.
double PixelModel::score_at(const double* plane, const Position& position) const {
  const std::int32_t to = next(position.bin);
  const double t = position.fraction;
  if (polynomials_) {
    const std::int32_t row = t < 0.5 ? position.bin : to;
    const double from_row = t < 0.5 ? t : t - 1.0;
    const auto [g, b, c] = rise_at(plane, row);
    return score_at(plane, row) +
           std::sqrt(own_[row]) * from_row * (g + from_row * (b / 2 + from_row * c / 3));
  }
  const double length2 = (1 - t) * (1 - t) * own_[position.bin] +
                         2 * t * (1 - t) * with_next_[position.bin] + t * t * own_[to];
  return ((1 - t) * along(plane, position.bin) + t * along(plane, to)) / std::sqrt(length2);
}

std::optional<Position> PixelModel::best_within(const double* plane, const RangePart& part) const {
  // A row's best position is up to one row away.
  const auto first = static_cast<std::int32_t>(std::floor(part.begin * samples_)) - 1;
  const auto count = static_cast<std::int32_t>(
      std::min<double>(samples_, std::ceil(part.length * samples_) + 3.0));
  const auto wrapped = [&](std::int32_t n) { return ((n % samples_) + samples_) % samples_; };
  std::optional<Position> best;
  double best_score = -std::numeric_limits<double>::infinity();
  double before = score_at(plane, wrapped(first - 1)), here = score_at(plane, wrapped(first));
  for (std::int32_t n = first; n < first + count; ++n) {
    const double after = score_at(plane, wrapped(n + 1));
    if (here >= before && here >= after && std::isfinite(here)) {
      const Position position = refine(plane, wrapped(n));
      const double score = score_at(plane, position);
      if (score > best_score && part.contains(position.in_rows(samples_) / samples_)) {
        best = position;
        best_score = score;
      }
    }
    before = here;
    here = after;
  }
  return best;
}

PixelEstimate PixelModel::estimate(const double* electrons, const double* plane,
                                   const Position& position, double* variance_e2,
                                   double variance_share) const {
  const int k_count = measurements(), r = rank();
  const std::int32_t from = position.bin, to = next(from);
  const double t = position.fraction;
  PixelEstimate result;

  // At a bin, use the mean slope of both sides.
  std::array<double, max_measurements> point, slope, weight;
  const double* p0 = projection_.curve.row(from).data();
  const double* p1 = projection_.curve.row(to).data();
  const double* before = projection_.curve.row(previous(from)).data();
  for (int j = 0; j < r; ++j) {
    const auto i = static_cast<std::size_t>(j);
    point[i] = (1 - t) * p0[j] + t * p1[j];
    slope[i] = t > 0.0 ? p1[j] - p0[j] : 0.5 * (p1[j] - before[j]);
  }

  const double length2 = dot(point.data(), point.data(), r);
  result.signal_e_per_s =
      polynomials_ ? signal_on_curve(plane, position) : dot(plane, point.data(), r) / length2;

  const double* x0 = projection_.gated.row(from).data();
  const double* x1 = projection_.gated.row(to).data();
  const Eigen::VectorXd& a = projection_.ambient;
  double with_ambient = 0.0;
  for (int k = 0; k < k_count; ++k)
    with_ambient += (electrons[k] - result.signal_e_per_s * ((1 - t) * x0[k] + t * x1[k])) * a[k];
  const double ambient2 = dot(a.data(), a.data(), k_count);
  result.ambient_e_per_s =
      ambient2 > 0.0 ? with_ambient / ambient2 : std::numeric_limits<double>::quiet_NaN();

  const double signal = std::max(result.signal_e_per_s, 0.0);
  const double ambient = ambient2 > 0.0 ? std::max(result.ambient_e_per_s, 0.0) : 0.0;
  const double* s0 = noise_.shot_gated.row(from).data();
  const double* s1 = noise_.shot_gated.row(to).data();
  for (int k = 0; k < k_count; ++k)
    variance_e2[k] =
        variance_share * std::max(min_variance_e2, signal * ((1 - t) * s0[k] + t * s1[k]) +
                                                       ambient * noise_.shot_ambient[k] +
                                                       noise_.floor_variance_e2[k]);

  // dS = <p, noise> / |p|^2, dz = <d, noise> / (S |d|^2) with the slope d across p.
  result.signal_standard_deviation_e_per_s = deviation_along(point.data(), variance_e2) / length2;
  const double turn = dot(slope.data(), point.data(), r) / length2;
  for (std::size_t j = 0; j < static_cast<std::size_t>(r); ++j)
    weight[j] = slope[j] - turn * point[j];
  const double across2 = dot(weight.data(), weight.data(), r);
  const double slope2 = dot(slope.data(), slope.data(), r);
  result.depth_standard_deviation_row =
      signal > 0.0 && across2 > parallel_chords * slope2
          ? deviation_along(weight.data(), variance_e2) / (signal * across2)
          : std::numeric_limits<double>::infinity();
  return result;
}

double PixelModel::deviation_along(const double* difference, const double* variance_e2) const {
  double variance = 0.0;
  for (int k = 0; k < measurements(); ++k) {
    const double weight = dot(noise_basis_.row(k).data(), difference, rank());
    variance += weight * weight * variance_e2[k];
  }
  return std::sqrt(variance);
}

namespace {

/// Rounding errors of float, relative to the signal.
constexpr double rounding_error = 2e-6;
/// Root mean square of t (1 - t) / 2 over a chord: sqrt(1 / 120).
constexpr double chord_error = 0.0913;
/// For more degrees of freedom, the least eigenvalue is bounded instead.
constexpr int most_eigenvalues = 8;
/// Minimum cosine between both chords of a bin of a smooth curve.
constexpr double smooth_turn = 0.9;

Eigen::VectorXd normalized_or_zero(const Eigen::VectorXd& vector) {
  return vector.isZero(0.0) ? vector : vector.normalized().eval();
}

/// The least variance along any combination of the columns, or a lower bound.
double least_variance(const Eigen::MatrixXd& columns, const Eigen::VectorXd& variance) {
  if (columns.cols() == 0) return 0.0;
  if (columns.cols() > most_eigenvalues) return std::max(variance.minCoeff(), 0.0);
  const Eigen::MatrixXd covariance = columns.transpose() * variance.asDiagonal() * columns;
  return std::max(columns.cols() == 1 ? covariance(0, 0) : least_eigenvalue(covariance), 0.0);
}

}  // namespace

ResidualModel::ResidualModel(const DecodingTable& table, const AmbientProjection& projection,
                             const DecodeOptions& options)
    : samples_(table.samples()),
      measurements_(table.measurements()),
      free_measurements_(measurements_),
      curve_(projection.gated),
      ambient_(projection.ambient),
      polynomials_(depth_polynomials(projection.curve)),
      noise_basis_(projection.noise_basis),
      noise_(table),
      least_noise_{least_variance_share * std::max(0.0, noise_.shot_gated.maxCoeff()),
                   least_variance_share * std::max(0.0, noise_.shot_ambient.maxCoeff()),
                   least_variance_share * noise_.floor_variance_e2.maxCoeff()} {
  if (polynomials_) plane_curve_ = projection.curve;
  noiseless_.resize(measurements_, 0);
  if (table.has_rows()) {
    whitening_ = table.whitening;
    curve_ *= whitening_.transpose();
    ambient_ = (whitening_ * ambient_).eval();
    for (int i = 0; i < measurements_; ++i) {
      if (!whitening_.row(i).isZero(0.0)) continue;
      noiseless_.conservativeResize(Eigen::NoChange, noiseless_.cols() + 1);
      noiseless_.rightCols(1) = Eigen::VectorXd::Unit(measurements_, i);
    }
    free_measurements_ -= static_cast<int>(noiseless_.cols());
  }
  ambient_ = normalized_or_zero(ambient_);
  Eigen::MatrixXd plane(measurements_, projection.rank() + 1 + noiseless_.cols());
  plane << projection.noise_basis, ambient_, noiseless_;
  off_plane_ = off_plane_noise_ = complement_of(plane);
  if (table.has_rows()) off_plane_ = whitening_.transpose() * off_plane_noise_;

  RowMajorMatrix half_way;
  if (polynomials_) half_way = SmoothCurve::of(plane_curve_)->points(0.5);
  DecodeOptions tolerant = options;
  tolerant.model_error_percent = std::max(options.model_error_percent, table.model_error_percent);
  limits_.resize(static_cast<std::size_t>(samples_));
  parallel_for_blocks(samples_, 64, [&](IndexRange bins) {
    for (std::int64_t n = bins.begin; n < bins.end; ++n)
      limits_[static_cast<std::size_t>(n)] =
          limit_at(static_cast<std::int32_t>(n), half_way, tolerant);
  });
  for (const Limit& limit : limits_)
    if (std::isfinite(limit.root))
      half_quantile_ = std::max(half_quantile_, 0.5 * limit.root * limit.root);
}

ResidualModel::Course ResidualModel::course_on_chords(std::int32_t row) const {
  const auto at = [this](std::int32_t n) -> Eigen::VectorXd {
    const Eigen::VectorXd x = curve_.row(n);
    return x - ambient_.dot(x) * ambient_;
  };
  const Eigen::VectorXd x = at(row), before = at(previous(row)), after = at(next(row));
  Course course;
  course.point = x;
  course.slope = Eigen::VectorXd::Zero(x.size());
  if (x.isZero(0.0)) return course;
  const auto across = [&x](const Eigen::VectorXd& chord) -> Eigen::VectorXd {
    const Eigen::VectorXd rest = chord - chord.dot(x) / x.squaredNorm() * x;
    return rest.squaredNorm() > parallel_chords * x.squaredNorm() ? rest
                                                                  : Eigen::VectorXd::Zero(x.size());
  };
  const Eigen::VectorXd to_before = across(before - x), to_after = across(after - x);
  course.slope = normalized_or_zero(to_after - to_before);
  course.has_slope = !to_before.isZero(0.0) || !to_after.isZero(0.0);
  course.is_corner = course.has_slope &&
                     !(-to_before.dot(to_after) > smooth_turn * to_before.norm() * to_after.norm());
  // The chord deviates from the curve by t (1 - t) / 2 times the second difference.
  const Eigen::VectorXd bend = chord_error * (before - 2.0 * x + after);
  const Eigen::VectorXd across_bend = bend - bend.dot(x) / x.squaredNorm() * x;
  course.error = (across_bend - course.slope.dot(across_bend) * course.slope).norm();
  return course;
}

ResidualModel::Course ResidualModel::course_on_curve(std::int32_t row,
                                                     const RowMajorMatrix& half_way) const {
  const Eigen::VectorXd p = plane_curve_.row(row), slope = polynomials_->slope.row(row);
  Course course;
  course.point = noise_basis_ * p;
  course.has_slope = slope.squaredNorm() * p.squaredNorm() > parallel_chords;
  course.slope = Eigen::VectorXd::Zero(course.point.size());
  if (course.has_slope) course.slope = noise_basis_ * slope.normalized();
  for (const bool is_after : {true, false}) {
    const double t = is_after ? 0.5 : -0.5;
    const Eigen::VectorXd bend = polynomials_->bend.row(row),
                          asymmetry = polynomials_->asymmetry.row(row),
                          there = half_way.row(is_after ? row : previous(row));
    const Eigen::VectorXd found =
        p + p.squaredNorm() * t * (slope + t * (0.5 * bend + t / 3.0 * asymmetry));
    const Eigen::VectorXd along = normalized_or_zero(slope + t * (bend + t * asymmetry));
    const Eigen::VectorXd missed = there.normalized() - found.normalized();
    course.error = std::max(course.error, p.norm() * (missed - along.dot(missed) * along).norm());
  }
  return course;
}

ResidualModel::Limit ResidualModel::limit_at(std::int32_t row, const RowMajorMatrix& half_way,
                                             const DecodeOptions& options) const {
  const Course course = polynomials_ ? course_on_curve(row, half_way) : course_on_chords(row);
  Limit limit;
  if (course.point.isZero(0.0)) return limit;
  const int freedom = degrees_of_freedom(course.has_slope);
  if (freedom < 1) return limit;
  limit.per_freedom = 1.0 / freedom;
  if (options.false_alarm_rate == 0.0) return limit;

  Eigen::MatrixXd known(measurements_, 3 + noiseless_.cols());
  known << ambient_, course.point.normalized(), course.slope, noiseless_;
  const Eigen::MatrixXd left = complement_of(known);
  const double quantile =
      chi_square_quantile_of_tail(options.false_alarm_rate, freedom + (course.is_corner ? 1 : 0));
  const Eigen::VectorXd shot = noise_.shot_gated.row(row)
                                   .cwiseMin(noise_.shot_gated.row(previous(row)))
                                   .cwiseMin(noise_.shot_gated.row(next(row)));
  limit.of_signal = quantile * least_variance(left, shot);
  limit.of_ambient = quantile * least_variance(left, noise_.shot_ambient);
  limit.of_floor = quantile * (least_variance(left, noise_.floor_variance_e2) + min_variance_e2);
  limit.error =
      (rounding_error + options.model_error_percent / 100.0) * course.point.norm() + course.error;
  limit.root = std::sqrt(quantile);
  return limit;
}

void ResidualModel::find_tangent(const Position& position, PerMeasurement& point,
                                 PerMeasurement& slope) const {
  const std::int32_t from = position.bin, to = next(from);
  const double t = position.fraction;
  const std::int32_t before = t > 0.0 ? from : previous(from);
  if (!polynomials_) {
    for (int k = 0; k < measurements_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      point[i] = (1 - t) * curve_(from, k) + t * curve_(to, k);
      slope[i] = curve_(to, k) - curve_(before, k);
    }
    return;
  }
  const std::int32_t row = t < 0.5 ? from : to;
  const double offset = t < 0.5 ? t : t - 1.0, own = plane_curve_.row(row).squaredNorm();
  point.fill(0.0);
  slope.fill(0.0);
  for (int j = 0; j < noise_basis_.cols(); ++j) {
    const double w = polynomials_->slope(row, j), b = polynomials_->bend(row, j),
                 c = polynomials_->asymmetry(row, j);
    const double along =
        plane_curve_(row, j) + own * offset * (w + offset * (b / 2 + offset * c / 3));
    const double rise = own * (w + offset * (b + offset * c));
    for (int k = 0; k < measurements_; ++k) {
      point[static_cast<std::size_t>(k)] += noise_basis_(k, j) * along;
      slope[static_cast<std::size_t>(k)] += noise_basis_(k, j) * rise;
    }
  }
}

PixelResidual ResidualModel::residual(const double* electrons, const PixelEstimate& estimate,
                                      const Position& position, double variance_share) const {
  const std::int32_t from = position.bin, to = next(from);
  const double t = position.fraction, signal = std::max(estimate.signal_e_per_s, 0.0);
  const double ambient = estimate.ambient_e_per_s > 0.0 ? estimate.ambient_e_per_s : 0.0;
  const Limit& limit = limits_[static_cast<std::size_t>(t < 0.5 ? from : to)];
  PixelResidual result;
  if (std::isnan(limit.per_freedom)) return result;

  const double least_e2 = std::max(
      min_variance_e2, signal * least_noise_[0] + ambient * least_noise_[1] + least_noise_[2]);
  PerMeasurement point, slope;
  find_tangent(position, point, slope);
  // Ambient light, signal, depth and measurements, in units of noise.
  std::array<PerMeasurement, 4> rows;
  for (int k = 0; k < measurements_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    double electrons_k = electrons[k];
    if (whitening_.size() > 0)
      electrons_k =
          whitening_.row(k).dot(Eigen::Map<const Eigen::VectorXd>(electrons, measurements_));
    const double variance = std::max(
        least_e2, signal * ((1 - t) * noise_.shot_gated(from, k) + t * noise_.shot_gated(to, k)) +
                      ambient * noise_.shot_ambient[k] + noise_.floor_variance_e2[k]);
    const double weight = 1.0 / std::sqrt(variance * variance_share);
    rows[0][i] = weight * ambient_[k];
    rows[1][i] = weight * point[i];
    rows[2][i] = weight * slope[i];
    rows[3][i] = weight * electrons_k;
  }
  const auto dot = [&](std::size_t a, std::size_t b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
      sum += rows[a][i] * rows[b][i];
    return sum;
  };
  // Gram-Schmidt; the last row becomes the residual.
  for (std::size_t a = 0; a < 3; ++a) {
    const double whole = dot(a, a);
    for (std::size_t b = 0; b < a; ++b) {
      const double own = dot(b, b);
      const double share = own > 0.0 ? dot(a, b) / own : 0.0;
      for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
        rows[a][i] -= share * rows[b][i];
    }
    const double own = dot(a, a);
    if (!(own > parallel_chords * whole)) {
      rows[a].fill(0.0);
      continue;
    }
    const double share = dot(a, 3) / own;
    for (std::size_t i = 0; i < static_cast<std::size_t>(measurements_); ++i)
      rows[3][i] -= share * rows[a][i];
  }
  const double chi2 = dot(3, 3);
  const double from_noise = std::sqrt(
      variance_share * (signal * limit.of_signal + ambient * limit.of_ambient + limit.of_floor));
  const double error = signal * limit.error;
  const double longest = from_noise + std::min(error, error * error * half_quantile_ / from_noise);
  result.per_freedom = chi2 * limit.per_freedom;
  result.is_inconsistent = std::sqrt(chi2) * from_noise > limit.root * longest;
  return result;
}

}  // namespace tofsmith
