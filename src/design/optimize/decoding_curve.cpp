// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/optimize/decoding_curve.hpp"

#include <algorithm>

#include "core/shared/whole_vectors.hpp"

namespace tofsmith {

namespace {

int padded_stride(int samples) { return whole_vectors(samples + 1) + widest_vector; }

/// Zero if ambient light is not estimated.
Eigen::VectorXd ambient_direction(const SampledCamera& camera, const MeasurementTable& table,
                                  const Eigen::VectorXd& relative_exposure) {
  const Eigen::VectorXd ambient = relative_exposure.cwiseProduct(table.ambient_gain);
  const double length = ambient.norm();
  if (!camera.ambient_unknown() || length == 0.0) return Eigen::VectorXd::Zero(ambient.size());
  return ambient / length;
}

}  // namespace

template <typename Value>
DecodingCurveOf<Value>::DecodingCurveOf(const SampledCamera& camera, const MeasurementTable& table,
                                        const Eigen::VectorXd& times_s)
    : samples(table.samples()),
      measurements(table.measurements()),
      stride(padded_stride(samples)),
      exposure_s(times_s) {
  const Eigen::VectorXd relative = exposure_s / exposure_s.mean();
  const Eigen::VectorXd direction = ambient_direction(camera, table, relative);
  exact_points = table.correlation * relative.asDiagonal();
  exact_points -= (exact_points * direction) * direction.transpose();
  const auto size = static_cast<std::size_t>(stride);
  points.assign(size * static_cast<std::size_t>(measurements), Value{0});
  squares.assign(size, Value{0});
  products.assign(size, Value{0});
  for (int j = 0; j <= samples; ++j) {
    const int at = j % samples, next = (at + 1) % samples;
    for (int r = 0; r < measurements; ++r)
      points[static_cast<std::size_t>(r) * size + static_cast<std::size_t>(j)] =
          static_cast<Value>(exact_points(at, r));
    squares[static_cast<std::size_t>(j)] = static_cast<Value>(exact_points.row(at).squaredNorm());
    products[static_cast<std::size_t>(j)] =
        static_cast<Value>(exact_points.row(at).dot(exact_points.row(next)));
  }
}

template <typename Value>
CurveGradientOf<Value>::CurveGradientOf(const DecodingCurveOf<Value>& curve)
    : points(curve.points.size(), Value{0}),
      squares(curve.squares.size(), Value{0}),
      next_squares(curve.squares.size(), Value{0}),
      products(curve.squares.size(), Value{0}) {}

template <typename Value>
void CurveGradientOf<Value>::clear() {
  for (Aligned<Value>* values : {&points, &squares, &next_squares, &products})
    std::fill(values->begin(), values->end(), Value{0});
}

template <typename Value>
void CurveGradientOf<Value>::pull_back(const SampledCamera& camera, const MeasurementTable& table,
                                       const DecodingCurveOf<Value>& curve,
                                       MeasurementTable& gradient,
                                       Eigen::VectorXd* by_exposure_s) const {
  const int samples = curve.samples;
  Eigen::MatrixXd by_points(samples, curve.measurements);
  for (int j = 0; j < samples; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const int next = (j + 1) % samples, last = (j + samples - 1) % samples;
    const double by_square = squares[at] + next_squares[static_cast<std::size_t>(last)];
    for (int r = 0; r < curve.measurements; ++r)
      by_points(j, r) =
          points[static_cast<std::size_t>(r) * static_cast<std::size_t>(curve.stride) + at] +
          2.0 * by_square * curve.exact_points(j, r) + products[at] * curve.exact_points(next, r) +
          products[static_cast<std::size_t>(last)] * curve.exact_points(last, r);
  }
  // p_j = x_j - a (a . x_j) / |a|^2, with a / |a| = n. The gradient w.r.t. x_j is P G_j; w.r.t. a
  // it is -sum_j [P G_j (n . x_j) + p_j (n . G_j)] / |a|.
  const Eigen::VectorXd exposure = curve.exposure_s / curve.exposure_s.mean();
  const Eigen::VectorXd direction = ambient_direction(camera, table, exposure);
  const Eigen::VectorXd along = by_points * direction;
  by_points -= along * direction.transpose();
  gradient.correlation += by_points * exposure.asDiagonal();
  Eigen::VectorXd by_ambient = Eigen::VectorXd::Zero(curve.measurements);
  if (!direction.isZero(0.0)) {
    const Eigen::VectorXd curve_along = (table.correlation * exposure.asDiagonal()) * direction;
    const double length = exposure.cwiseProduct(table.ambient_gain).norm();
    by_ambient =
        -(by_points.transpose() * curve_along + curve.exact_points.transpose() * along) / length;
    gradient.ambient_gain += by_ambient.cwiseProduct(exposure);
  }
  if (!by_exposure_s) return;
  // x_i = g_i chi_i, a_i = g_i kappa_i, and g_i = T_i / mean T has the mean 1.
  const Eigen::VectorXd by_relative =
      by_points.cwiseProduct(table.correlation).colwise().sum().transpose() +
      by_ambient.cwiseProduct(table.ambient_gain);
  const double along_times = by_relative.dot(exposure) / curve.measurements;
  *by_exposure_s += (by_relative.array() - along_times).matrix() / curve.exposure_s.mean();
}

template struct DecodingCurveOf<float>;
template struct DecodingCurveOf<double>;
template struct CurveGradientOf<float>;
template struct CurveGradientOf<double>;

}  // namespace tofsmith
