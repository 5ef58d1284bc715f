// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace tofsmith {

/// Information on the delay of a light of given shape behind arms of one transfer function, where
/// photons are recorded one by one.
/// @see docs/bounds.md
class PhotonInformation {
 public:
  /// @param transfer  harmonics 0 .. highest of what blurs the light
  /// @param may_ring  whether the response may really fall below 0, as a measured one may; else
  ///                  values below 0 come from the harmonics left out
  PhotonInformation(const Eigen::VectorXcd& transfer, bool may_ring);

  /// Integral over the period of (s x')^2 / (s x + other) for x the arms' response itself: what no
  /// light of mean at most 1 exceeds. Infinite where s x + other is not above 0.
  /// @param signal_e  s, electrons of the light
  /// @param other_e   variance of everything else, were it all collected with the light
  double of_impulses(double signal_e, double other_e) const;
  /// s^2 / other times the largest mean of x'^2 of a light within [0, peak_factor] and of mean at
  /// most 1.
  double of_ripple(double signal_e, double other_e, double peak_factor) const;
  /// The smaller of both.
  double largest(double signal_e, double other_e, double peak_factor) const;

  /// max (2 pi n |H_n|)^2.
  double largest_slope_power() const { return largest_slope_power_; }
  /// How far below 0 a light within [0, peak_factor] and of mean at most 1 can come: 0 unless the
  /// response itself does.
  double undershoot(double peak_factor) const;

 private:
  Eigen::VectorXd response_, slope_;  // over one period
  bool may_ring_;
  double largest_slope_power_ = 0.0;
};

/// Integral over the period of (s x')^2 / (s x + other), x and x' sampled at equal distances.
double information_of_shape(const Eigen::VectorXd& shape, const Eigen::VectorXd& slope,
                            double signal_e, double other_e);

/// A real signal and its slope per period, from harmonics 0 .. highest, at 4 x highest points.
void sample_with_slope(const Eigen::VectorXcd& harmonics, Eigen::VectorXd& values,
                       Eigen::VectorXd& slope);

}  // namespace tofsmith
