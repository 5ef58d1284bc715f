// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/pixel_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

}  // namespace tofsmith
