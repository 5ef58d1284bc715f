// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "decode/multipath/multipath_search.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Weighted least squares of one or two returns by exhaustive search over a fine grid, with exact
/// correlation functions, in double. As in SingleFits, chi^2 excludes the part that no return can
/// explain.
class ReferenceReturns {
 public:
  ReferenceReturns(const ForwardModel& model, const PixelGroup& group) {
    const Eigen::Index k_count = model.measurements();
    Eigen::VectorXd weight(k_count);
    target_.resize(k_count);
    for (Eigen::Index k = 0; k < k_count; ++k) {
      weight[k] = 1.0 / std::sqrt(double{group.variance_e2[k][0]});
      target_[k] = weight[k] * group.electrons[k][0];
    }
    Eigen::MatrixXd curve =
        model.correlation_table(places) * (model.exposure_s().cwiseProduct(weight)).asDiagonal();
    const Eigen::VectorXd ambient =
        model.exposure_s().cwiseProduct(model.ambient_gain()).cwiseProduct(weight).normalized();
    target_ -= target_.dot(ambient) * ambient;
    curve -= (curve * ambient) * ambient.transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(curve, Eigen::ComputeThinV);
    const Eigen::Index rank =
        (svd.singularValues().array() > 1e-6 * svd.singularValues()[0]).count();
    const Eigen::MatrixXd basis = svd.matrixV().leftCols(rank);
    target_ = basis.transpose() * target_;
    curve_ = curve * basis;
  }

  double best_single_chi2() const {
    double explained = 0.0;
    for (Eigen::Index j = 0; j < places; ++j) {
      const double b = std::max(curve_.row(j).dot(target_), 0.0);
      explained = std::max(explained, b * b / curve_.row(j).squaredNorm());
    }
    return target_.squaredNorm() - explained;
  }

  /// @param shortest, longest  limits of the delay [periods]
  double best_pair_chi2(double shortest, double longest) const {
    const Eigen::VectorXd along = curve_ * target_;
    const Eigen::MatrixXd gram = curve_ * curve_.transpose();
    double explained = 0.0;
    for (Eigen::Index j = 0; j < places; ++j)
      for (auto lag = static_cast<Eigen::Index>(std::ceil(shortest * places));
           lag <= static_cast<Eigen::Index>(longest * places); ++lag) {
        const Eigen::Index k = (j + lag) % places;
        const double det = gram(j, j) * gram(k, k) - gram(j, k) * gram(j, k);
        const double n1 = gram(k, k) * along[j] - gram(j, k) * along[k];
        const double n2 = gram(j, j) * along[k] - gram(j, k) * along[j];
        const double sum = std::max(along[j] + along[k], 0.0);
        if (n2 > n1)
          explained = std::max(explained, sum * sum / (gram(j, j) + 2 * gram(j, k) + gram(k, k)));
        else if (n2 >= 0.0 && det > 0.0)
          explained = std::max(explained, (n1 * along[j] + n2 * along[k]) / det);
      }
    return target_.squaredNorm() - explained;
  }

 private:
  static constexpr int places = 480;
  Eigen::VectorXd target_;
  Eigen::MatrixXd curve_;
};

}  // namespace tofsmith
