// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "tofsmith/camera/returns.hpp"

namespace tofsmith {

/// Cramer-Rao bound of direct depth where light comes back twice: the inverse Fisher matrix over
/// (z, delta, S1, S2, A) of the expected measurements, weighted by their variance, which holds the
/// light of both returns. Behind a tail of known mean delay: over (z, S1, S2, A).
/// @note two returns pay only where this is below the bias of single-path decoding
class MultipathBound {
 public:
  /// @param camera  the one `model` was made with
  MultipathBound(const ForwardModel& model, const Camera& camera);

  /// Smallest standard deviation of direct depth [m], at the middle of each bin (N).
  Eigen::VectorXd sigma_m(const OperatingPoint& point, double ratio, double delay_m) const;
  Eigen::VectorXd tail_sigma_m(const OperatingPoint& point, const ExponentialTail& tail) const;
  /// Mean over depth of sqrt(2 / pi) sigma, at each depth held to range / 4, the mean circular
  /// error of a guess [m].
  double mae_m(const Eigen::VectorXd& sigma_m) const;

 private:
  Eigen::VectorXd sigma_of(const OperatingPoint& point, double ratio, const Eigen::MatrixXd& later,
                           Eigen::Index shift, bool delay_is_known) const;

  int samples_;
  double range_m_;
  Eigen::MatrixXd readout_, table_;  // T o chi of the tap values, (points, taps)
  Eigen::VectorXd ambient_, shot_ambient_, floor_variance_e2_;
};

/// Bias of single-path decoding behind a second return, where it is closer than the correlation
/// functions' features: r delta / (1 + r) [m], with every code.
double single_path_bias_m(double ratio, double delay_m);

}  // namespace tofsmith
