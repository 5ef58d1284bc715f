// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/return_posterior.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tofsmith {

namespace {

constexpr int delays_taken = 18, ratios_taken = 8;
constexpr double reach_m = 1.7;

/// Measurements and curve in coordinates in which noise is white and ambient light gone; rows of
/// the curve from `first` on.
struct WhitePixel {
  Eigen::VectorXd target;
  RowMajorMatrix direct, behind;  // (rows, span); `behind` of a tail

  WhitePixel(const MultipathCurve& curve, const PixelGroup& pixels, int lane, int first, int rows) {
    const int dims = curve.dims(), from = curve.sees_ambient ? 1 : 0;
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(dims, dims);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(dims);
    for (int k = 0; k < curve.measurements; ++k) {
      const Eigen::VectorXd column =
          Eigen::Map<const Eigen::VectorXf>(curve.basis.data() + k * dims, dims).cast<double>();
      const double weight = 1.0 / pixels.variance_e2[k][lane];
      information += weight * column * column.transpose();
      sum += weight * pixels.electrons[k][lane] * column;
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(information);
    target = factor.matrixL().solve(sum).tail(curve.span);
    const Eigen::MatrixXd plane =
        Eigen::MatrixXd(factor.matrixL()).block(from, from, curve.span, curve.span);
    const auto white = [&](const std::vector<float>& table) {
      RowMajorMatrix values(rows, curve.span);
      for (int i = 0; i < rows; ++i) {
        const int at = ((first + i) % curve.points + curve.points) % curve.points;
        values.row(i) =
            Eigen::Map<const Eigen::RowVectorXf>(table.data() + at * curve.span, curve.span)
                .cast<double>() *
            plane;
      }
      return values;
    };
    direct = white(curve.fine);
    if (!curve.tail.empty()) behind = white(curve.tail);
  }
};

/// Half of what signal along a curve point explains.
double explained(double along, double own) {
  return along > 0.0 && own > 0.0 ? 0.5 * along * along / own : 0.0;
}

}  // namespace

ReturnPosterior::ReturnPosterior(const MultipathCurve& curve, const ReturnPrior& prior,
                                 double range_m, const DelayBounds& delays)
    : single_probability_(prior.single_probability),
      reach_(static_cast<int>(std::min(0.45, reach_m / range_m) * curve.points)) {
  const double points_per_m = curve.points / range_m;
  for (int i = 0; i < (curve.tail.empty() ? delays_taken : 1); ++i) {
    const double delay_m = -prior.mean_delay_m * std::log1p(-(i + 0.5) / delays_taken);
    delay_.push_back(curve.tail.empty()
                         ? static_cast<int>(std::lround(std::min(
                               points_per_m * delay_m, static_cast<double>(delays.longest))))
                         : 0);
  }
  for (int i = 0; i < ratios_taken; ++i)
    ratio_.push_back(prior.largest_ratio * (i + 0.5) / ratios_taken);
}

DepthPosterior ReturnPosterior::around(const MultipathCurve& curve, const PixelGroup& pixels,
                                       int lane, double position) const {
  const int first = static_cast<int>(std::lround(position)) - reach_, places = 2 * reach_ + 1;
  const int rows = places + *std::max_element(delay_.begin(), delay_.end());
  const WhitePixel white(curve, pixels, lane, first, rows);
  const RowMajorMatrix& behind = curve.tail.empty() ? white.direct : white.behind;
  const Eigen::VectorXd along = white.direct * white.target;
  const Eigen::VectorXd own = white.direct.rowwise().squaredNorm();
  const Eigen::VectorXd later_along = behind * white.target;
  const Eigen::VectorXd later_own = behind.rowwise().squaredNorm();

  const double most = 0.5 * white.target.squaredNorm();  // no fit explains more
  const double per_pair =
      (1.0 - single_probability_) / static_cast<double>(delay_.size() * ratio_.size());
  std::vector<double> density(static_cast<std::size_t>(places));
  double whole = 0.0;
  for (int z = 0; z < places; ++z) {
    double sum = single_probability_ * std::exp(explained(along[z], own[z]) - most);
    for (const int delay : delay_) {
      const double between = white.direct.row(z).dot(behind.row(z + delay));
      for (const double r : ratio_)
        sum +=
            per_pair * std::exp(explained(along[z] + r * later_along[z + delay],
                                          own[z] + 2 * r * between + r * r * later_own[z + delay]) -
                                most);
    }
    density[static_cast<std::size_t>(z)] = sum;
    whole += sum;
  }
  if (!(whole > 0.0)) return {position, 0.0};
  double before = 0.0, mean = 0.0, square = 0.0, median = 0.0;
  bool passed = false;
  for (int z = 0; z < places; ++z) {
    const double here = density[static_cast<std::size_t>(z)] / whole;
    if (!passed && before + here >= 0.5) {
      median = z - 0.5 + (0.5 - before) / here;
      passed = true;
    }
    before += here;
    mean += here * z;
    square += here * z * z;
  }
  const double at = first + median;
  return {at - curve.points * std::floor(at / curve.points),
          std::sqrt(std::max(square - mean * mean, 0.0))};
}

}  // namespace tofsmith
