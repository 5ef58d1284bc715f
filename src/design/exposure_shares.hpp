// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// As a share of the integration time.
inline constexpr double min_exposure_share = 0.01;

/// Returns min_exposure_share + (1 - E min_exposure_share) softmax(logits): shares of sum 1 (E).
Eigen::VectorXd shares_of_logits(const Eigen::VectorXd& logits);
/// Inverse of shares_of_logits(), with mean 0; smaller shares count as slightly above the smallest.
Eigen::VectorXd logits_of_shares(const Eigen::VectorXd& shares);
/// Converts a gradient w.r.t. the shares to one w.r.t. the logits.
Eigen::VectorXd pull_back_shares(const Eigen::VectorXd& shares, const Eigen::VectorXd& by_shares);

/// Returns a function of the shares and writes its gradient (E).
using ShareObjective =
    std::function<double(const Eigen::VectorXd& shares, Eigen::VectorXd& by_shares)>;

/// Minimizes a function that decreases with each share, such as the logarithm of a bound, over
/// shares of sum 1 that are at least min_exposure_share. Multiplies each share by a power of its
/// derivative, 1/2 at first: for variances a_e / share_e that add, one step gives the optimum,
/// shares proportional to sqrt(a_e). The result is never worse than the start.
/// @see Fellman, "On the allocation of linear observations", 1974; Torsney, "A moment inequality
///   and monotonicity of an algorithm", 1983
Eigen::VectorXd minimize_over_shares(Eigen::VectorXd shares, const ShareObjective& objective);

/// Cramer-Rao bound of a code as a function of the shares of its exposures in the integration time.
/// With u_i the derivatives of the measurement rate r_i w.r.t. depth, signal and ambient light,
///   F = sum_i w_i u_i u_i^T,  w_i = T_i^2 / (T_i v_i + c_i),
///   sigma = ([F^-1]_zz^-1 + 12 / R^2)^(-1/2).
/// The term of the range R, the prior information of uniform depths, limits sigma at low light.
class ExposureBound {
 public:
  /// @param camera  total integration time; has no list of times
  /// @throws InvalidArgument if the camera does not support the code
  ExposureBound(const CodeSet& code, const Camera& camera);

  /// Returns the mean over operating points of log sigma, with the mean or root mean square over
  /// depths as selected by the camera, and writes the gradient w.r.t. the shares (E).
  double log_deviation(const Eigen::VectorXd& shares, Eigen::VectorXd& by_shares) const;
  double log_deviation(const Eigen::VectorXd& shares) const;

  /// Returns the shares with the smallest bound (E).
  Eigen::VectorXd best_shares() const;
  /// Returns the bound of equal exposures divided by the bound of these shares.
  double gain(const Eigen::VectorXd& shares) const;

 private:
  struct Level {
    double log_deviation = 0.0;
    Eigen::VectorXd by_shares;
  };
  Level level(const OperatingPoint& point, const Eigen::VectorXd& shares) const;

  Eigen::Index exposures_;
  double total_s_;
  double range_m_;
  bool root_mean_square_;
  std::vector<OperatingPoint> points_;
  std::vector<double> albedos_, albedo_weights_;
  std::vector<Eigen::Index> exposure_of_;  // of each measurement
  // Rates per unit of signal (depths, K) and of ambient light (K).
  Eigen::MatrixXd signal_, slope_, shot_signal_;
  Eigen::VectorXd ambient_, shot_ambient_;
  Eigen::VectorXd dark_variance_e2_per_s_, constant_variance_e2_;  // (K)
  Eigen::VectorXd masses_;                                         // probabilities of the depths
};

/// Returns the shares of a code as a vector, equal ones if it has none (E).
Eigen::VectorXd shares_of(const CodeSet& code);

}  // namespace tofsmith
