// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/mixed/mixed_pixel_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

namespace {

/// Chi^2 thresholds: two returns must be better than either surface alone by `better`, and may be
/// worse than a single return by `little_worse`, because both surfaces are likely next to an edge.
constexpr double better = 3.0, little_worse = 25.0;
/// As `better` if the decoded depth is that of a surface.
constexpr double far_better = 20.0;
/// Fraction of the chi^2 of a single surface that may remain: surfaces are not flat, and lens blur
/// varies.
constexpr double may_remain = 0.25;
/// More averaged measurements do not count: model errors dominate.
constexpr double most_averaged = 16.0;
/// Minimum standard deviation of interpolated depths [bin].
constexpr double least_deviation_bins = 0.05;

}  // namespace

MixedPixelFit::MixedPixelFit(const DecodingTable& table)
    : measurements_(table.measurements()),
      samples_(table.samples()),
      range_m_(table.range_m),
      noise_(table) {
  const AmbientProjection projection(table);
  rank_ = projection.rank();
  gated_ = projection.gated;
  ambient_ = projection.ambient;
  has_ambient_ = !ambient_.isZero(0.0);
}

MixedPixelFit::Return MixedPixelFit::return_at(double depth_m) const {
  double bin = std::fmod(depth_m / range_m_ * samples_, samples_);
  if (bin < 0.0) bin += samples_;
  const int from = std::min(static_cast<int>(bin), samples_ - 1), to = (from + 1) % samples_;
  const double t = bin - from;
  Return r;
  for (int k = 0; k < measurements_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    r.light[i] = (1 - t) * gated_(from, k) + t * gated_(to, k);
    r.per_m[i] = (gated_(to, k) - gated_(from, k)) * samples_ / range_m_;
    r.shot[i] = (1 - t) * noise_.shot_gated(from, k) + t * noise_.shot_gated(to, k);
  }
  return r;
}

template <int Returns>
MixedPixelFit::Fit MixedPixelFit::fit(const double* electrons, const Measured& weight,
                                      const std::array<const Return*, Returns>& returns) const {
  constexpr int unknowns = Returns + 1;
  using Vector = Eigen::Matrix<double, unknowns, 1>;
  Eigen::Matrix<double, unknowns, unknowns> normal;
  normal.setZero();
  Vector right = Vector::Zero();
  const auto column = [&](int k) {
    Vector x;
    for (int j = 0; j < Returns; ++j)
      x[j] = returns[static_cast<std::size_t>(j)]->light[static_cast<std::size_t>(k)];
    x[Returns] = ambient_[k];
    return x;
  };
  for (int k = 0; k < measurements_; ++k) {
    const Vector x = column(k);
    const double w = weight[static_cast<std::size_t>(k)];
    normal += w * x * x.transpose();
    right += w * electrons[k] * x;
  }
  if (!has_ambient_) normal(Returns, Returns) = 1.0;
  const Vector amount = normal.ldlt().solve(right);
  Fit found;
  found.amount.setZero();
  for (int j = 0; j < unknowns; ++j) found.amount[j] = amount[j];
  for (int k = 0; k < measurements_; ++k) {
    const double left = electrons[k] - column(k).dot(amount);
    found.chi2 += weight[static_cast<std::size_t>(k)] * left * left;
  }
  return found;
}

MixedPixelFit::Explanation MixedPixelFit::explain(const double* electrons, double averaged,
                                                  double decoded_m, const SurfaceDepth& first,
                                                  const SurfaceDepth& second) const {
  const Return near = return_at(first.depth_m), far = return_at(second.depth_m);
  Measured weight;
  weight.fill(1.0);
  Fit two = fit<2>(electrons, weight, {&near, &far});
  // Repeat with the noise of the estimated light.
  const double s1 = std::max(0.0, two.amount[0]), s2 = std::max(0.0, two.amount[1]);
  const double a = std::max(0.0, two.amount[2]);
  const double least_m = least_deviation_bins * range_m_ / samples_;
  const double d1 = s1 * std::max(first.deviation_m, least_m);
  const double d2 = s2 * std::max(second.deviation_m, least_m);
  const double n = std::clamp(averaged, 1e-3, most_averaged);
  for (int k = 0; k < measurements_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double variance = (s1 * near.shot[i] + s2 * far.shot[i] + a * noise_.shot_ambient[k] +
                             noise_.floor_variance_e2[k]) /
                                n +
                            d1 * d1 * near.per_m[i] * near.per_m[i] +
                            d2 * d2 * far.per_m[i] * far.per_m[i];
    weight[i] = 1.0 / std::max(variance, min_variance_e2);
  }
  two = fit<2>(electrons, weight, {&near, &far});
  Explanation found{
      .first_e_per_s = two.amount[0], .second_e_per_s = two.amount[1], .chi2 = two.chi2};
  if (!(two.amount[0] > 0.0 && two.amount[1] > 0.0)) return found;
  const double one =
      std::min(fit<1>(electrons, weight, {&near}).chi2, fit<1>(electrons, weight, {&far}).chi2);
  const Return own = return_at(std::isfinite(decoded_m) ? decoded_m : first.depth_m);
  const double single = fit<1>(electrons, weight, {&own}).chi2;
  found.is_two = two.chi2 + better < one && two.chi2 < single + little_worse + may_remain * one;
  found.is_no_single = found.is_two && two.chi2 + far_better < single;
  return found;
}

}  // namespace tofsmith
