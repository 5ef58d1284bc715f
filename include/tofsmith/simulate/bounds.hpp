// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/camera/forward_model.hpp"
#include "tofsmith/simulate/photon_information.hpp"

namespace tofsmith {

/// Which information a Cramer-Rao bound counts.
enum class NoiseInformation {
  mean,               ///< what the expected measurements tell, weighted by 1 / variance
  mean_and_variance,  ///< also what the size of the noise tells (under 0.1 % more)
};

/// How well any unbiased estimator can measure depth with one code, signal and ambient unknown.
/// @see docs/bounds.md
class CramerRaoBound {
 public:
  /// Depths at the middle of cells of 1/4 bin; slopes are means over a cell.
  /// @param camera  the one `model` was made with
  CramerRaoBound(const ForwardModel& model, const Camera& camera,
                 NoiseInformation information = NoiseInformation::mean);

  /// Smallest standard deviation [m] at each of the 4 N depths: the root of the depth entry of the
  /// inverse Fisher matrix over (depth, S, A), variance mu_i + constant variance. Infinite where
  /// depth cannot be told from signal and ambient.
  Eigen::VectorXd sigma_m(const OperatingPoint& point) const;
  /// Mean over depth of sqrt(2 / pi) sigma: the mean absolute error of a normal deviation [m].
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1); at each albedo held to range / 4,
  /// the mean circular error of a guess, without which the average diverges.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  NoiseInformation information_;
  // Electrons per unit of S (4 N, K) and of A (K), of measurements and of the light they are made
  // of; slopes per period.
  Eigen::MatrixXd signal_, signal_slope_, shot_signal_, shot_signal_slope_;
  Eigen::VectorXd ambient_, shot_ambient_;
  Eigen::VectorXd constant_variance_e2_;
};

/// How well any code at all can do on a camera, in a number of exposures: below every
/// CramerRaoBound of a code whose harmonics the camera's arms limit, and 0 without impulse
/// responses.
/// @see docs/bounds.md for derivation and assumptions
class ReceiverBound {
 public:
  /// @param exposures  E >= 1
  /// @throws std::invalid_argument if the camera is invalid
  ReceiverBound(const Camera& camera, int exposures);

  /// Mean over depth of the largest information on depth [1 / period^2] that taps can gather: from
  /// the largest harmonic the arms let through and from how much a gate of duty kappa can hold.
  double tap_information(const OperatingPoint& point) const;
  /// The same for photons recorded one by one behind both arms, one read-out per exposure: from
  /// the arms' response itself or from the largest ripple within the peak, whichever is less.
  double photon_information(const OperatingPoint& point) const;
  /// range sqrt(2 / pi) / sqrt(smaller of both) [m].
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1), at each albedo held to range / 4.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  int taps_;
  bool drain_;
  double peak_factor_;
  double sensitivity_;  // of the most sensitive tap
  double dark_e_per_s_;
  double constant_variance_e2_;
  std::vector<double> exposure_s_;            // of each exposure
  std::optional<PhotonInformation> photons_;  // behind both arms; none without limit
};

}  // namespace tofsmith
