// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Fisher information on the delay of light if photons are recorded individually behind one or both
/// arms of the camera. @see docs/bounds.md
class PhotonInformation {
 public:
  /// @param transfer  harmonics 0, 1, ... of the blur
  /// @param may_ring  the response may be negative, e.g. if measured; otherwise negative values are
  ///                  attributed to missing harmonics
  PhotonInformation(const Eigen::VectorXcd& transfer, bool may_ring);

  /// Returns the integral over the period of (s x')^2 / (s x + other), with x the response of the
  /// arms: an upper limit for any light of mean at most 1. Infinite unless s x + other > 0.
  /// @param signal_e, other_e  s, and the variance of everything else that is collected
  double of_impulses(double signal_e, double other_e) const;
  /// Upper limit on s^2 / other times the mean of x'^2, for any light within [0, peak_factor] and
  /// of mean at most 1.
  double of_ripple(double signal_e, double other_e, double peak_factor) const;
  /// Smaller of the two limits.
  double largest(double signal_e, double other_e, double peak_factor) const;

  /// max (2 pi n |H_n|)^2.
  double largest_slope_power() const { return largest_slope_power_; }
  /// Largest magnitude of negative values after the blur of light as in of_ripple(); 0 unless the
  /// response is negative somewhere.
  double undershoot(double peak_factor) const;

 private:
  Eigen::VectorXd response_, slope_;
  bool may_ring_;
  double largest_slope_power_ = 0.0;
};

/// Upper limit on the information of one tap on a delay, for any light of mean at most 1 and any
/// gate 0 <= d <= 1, as a function of the electrons x that the gate passes, from Phi(x) >= |slope
/// of x| and Psi(x) >= |curvature of x|. @see docs/bounds.md
class GateInformation {
 public:
  /// @param transfer  harmonics 0, 1, ... of the blur, whose response must not ring
  explicit GateInformation(const Eigen::VectorXcd& transfer);

  /// Upper limit max Phi^2 / (x + other) on the information [1 / period^2] at any depth.
  /// @param signal_e   s, electrons of the light if the gate were always open
  /// @param ambient_e  a, the same for ambient light
  /// @param other_e2   variance without light
  double at_any_depth(double signal_e, double ambient_e, double other_e2) const;

  /// Tighter limit for the mean over all depths: the maximum over turning points a and b of x, with
  /// z(x) its largest possible squared slope, of
  ///   integral sqrt(z) / (x + other) dx  /  integral dx / sqrt(z)   from a to b.
  double mean_over_depths(double signal_e, double ambient_e, double other_e2) const;

 private:
  Eigen::ArrayXd response_, slope_, curvature_;
};

/// Integral over the period of (s x')^2 / (s x + other) for equidistant samples.
double information_of_shape(const Eigen::VectorXd& shape, const Eigen::VectorXd& slope,
                            double signal_e, double other_e);

/// Evaluates a signal and its slope per period at 4 n points, from harmonics 0 to n.
void sample_with_slope(const Eigen::VectorXcd& harmonics, Eigen::VectorXd& values,
                       Eigen::VectorXd& slope);

/// Information used by a Cramer-Rao bound.
enum class NoiseInformation {
  mean,               ///< of the expected measurements, weighted by 1 / variance
  mean_and_variance,  ///< also from the noise level (< 0.1 % more)
};

/// Cramer-Rao bound on depth for one code with unknown signal and ambient light, see
/// docs/bounds.md.
class CramerRaoBound {
 public:
  /// @param cells_per_bin  default: 4, or more if the highest harmonics require it
  CramerRaoBound(const ForwardModel& model, const Camera& camera,
                 NoiseInformation information = NoiseInformation::mean,
                 std::optional<int> cells_per_bin = std::nullopt);

  /// Smallest standard deviation of unbiased estimators [m] per cell of depth, from the inverse
  /// Fisher matrix over (depth, S, A). Infinite if depth cannot be separated from the light.
  Eigen::VectorXd sigma_m(const OperatingPoint& point) const;
  /// Mean over the camera's depths of sqrt(2 / pi) sigma, the mean absolute normal deviation [m].
  double mae_m(const OperatingPoint& point) const;
  /// Mean over a signal scaled uniformly in (0, 1), limited at each albedo to range / 4, the mean
  /// circular error of a guess.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  NoiseInformation information_;
  // Electrons per unit of S (cells, K) and of A (K), for measurements and shot noise.
  Eigen::MatrixXd signal_, signal_slope_, shot_signal_, shot_signal_slope_;
  Eigen::VectorXd ambient_, shot_ambient_;
  Eigen::VectorXd constant_variance_e2_;
  Eigen::VectorXd masses_;  // share of depths in each cell; empty: uniform
  /// Covariance of rows, whose noise is correlated.
  std::optional<RowCovariance> covariance_;
  Eigen::MatrixXd covariance_slope_;

  Eigen::Matrix<double, Eigen::Dynamic, 3> whitened_jacobian(Eigen::Index depth,
                                                             const OperatingPoint& point) const;
  Eigen::Matrix<double, Eigen::Dynamic, 3> whitened_jacobian_of_rows(
      Eigen::Index depth, const OperatingPoint& point) const;
};

/// Bound for unbiased estimators that observe all N time bins of an exposure with the light of a
/// code of rows (Readout::rows): below the CramerRaoBound of any rows. Signal and ambient light are
/// unknown, and there is no read noise.
class HistogramBound {
 public:
  /// @throws std::invalid_argument unless model.has_rows()
  HistogramBound(const ForwardModel& model, const Camera& camera);

  /// Mean over depth of sqrt(2 / pi) sigma [m].
  double mae_m(const OperatingPoint& point) const;
  /// As CramerRaoBound::mae_uniform_albedo_m().
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  Eigen::MatrixXd light_, slope_;  // electrons of all bins per unit of S, (N, depths in a bin)
  Eigen::VectorXd masses_;         // share of depths at each position in a bin; empty: uniform
  double ambient_e_ = 0.0, dark_e_ = 0.0;  // per bin
};

/// Lower limit on the circular error of any code with a given number of exposures, from the
/// harmonics that the camera's arms pass; 0 without impulse responses. For rows, photons are
/// recorded individually without read noise.
/// @see docs/bounds.md
class ReceiverBound {
 public:
  /// @throws std::invalid_argument if the camera is invalid
  ReceiverBound(const Camera& camera, int exposures);

  /// Upper limit on the mean over depth of the information [1 / period^2] of taps, from the
  /// harmonics of arms and gate, times the largest relative density of depths.
  double tap_information(const OperatingPoint& point) const;
  /// For photons recorded individually behind both arms, with one read-out per exposure (two for
  /// differences): smallest of the limits from the arms' response, the largest ripple within the
  /// peak, and GateInformation::at_any_depth().
  double photon_information(const OperatingPoint& point) const;
  /// For photons that pass gates: GateInformation::mean_over_depths(). Infinite for rows, mixers
  /// with analog weights and measured responses, which may ring.
  double gate_information(const OperatingPoint& point) const;
  /// Smallest of these limits.
  double information(const OperatingPoint& point) const;

  /// Lower limit on the mean circular error [m] of any estimator, biased or not, with S and A
  /// known: the Ziv-Zakai bound, from range / 4 without light to about range sqrt(2 / pi) /
  /// sqrt(information) in bright light; if depths are not uniform, the latter at all light levels.
  double mae_m(const OperatingPoint& point) const;
  /// As CramerRaoBound::mae_uniform_albedo_m().
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  int taps_;
  bool has_rows_;
  bool drain_;
  int read_outs_;  // minimum per measurement
  double peak_factor_;
  double sensitivity_;  // of the most sensitive tap
  double dark_e_per_s_;
  double constant_variance_e2_;
  double max_density_;  // of depths, relative to uniform
  std::vector<double> exposure_s_;
  std::optional<PhotonInformation> photons_;  // none if unlimited
  std::optional<GateInformation> gates_;      // none if unlimited, rows or ringing
  Eigen::VectorXd transfer_power_;            // |H|^2 of both arms at harmonics 1, 2, ...

  double gathered(const OperatingPoint& point) const;
  double recorded_information(const OperatingPoint& point, bool by_gates) const;
};

/// Bound set by the light alone: an ideal direct time-of-flight receiver that records individual
/// photons, with the camera's light source and total exposure time, and known signal and ambient
/// light.
///   J <= T integral over the period of (S m')^2 / (S m + A) du
/// It never exceeds ReceiverBound, except possibly for a measured sensor response that rings.
/// @see docs/bounds.md
class DirectTofBound {
 public:
  /// @throws std::invalid_argument if the camera is invalid
  explicit DirectTofBound(const Camera& camera);

  /// Upper limit within the camera's peak and average power [1 / period^2]; infinite if the light
  /// has no impulse response.
  double photon_information(const OperatingPoint& point) const;
  /// The Ziv-Zakai bound [m] if depths are uniform, else range sqrt(2 / pi) / sqrt(information).
  double mae_m(const OperatingPoint& point) const;
  /// As CramerRaoBound::mae_uniform_albedo_m().
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

  /// Information of one modulation [1 / period^2]; infinite without impulse response.
  double information_of(const Waveform& modulation, const OperatingPoint& point) const;

 private:
  double range_m_;
  double exposure_s_;  // total, times the sensitivity of the best tap
  double peak_factor_;
  double max_density_;                        // of depths, relative to uniform
  Eigen::VectorXcd transfer_;                 // of the light; empty if unlimited
  std::optional<PhotonInformation> photons_;  // none if unlimited
};

/// Cramer-Rao bound on the direct depth with a second return, from the Fisher matrix over (z,
/// delta, S1, S2, A); with a tail of known mean delay, over (z, S1, S2, A). Decoding two returns is
/// only worthwhile where the bound is below the bias of single-path decoding.
class MultipathBound {
 public:
  MultipathBound(const ForwardModel& model, const Camera& camera);

  /// Smallest standard deviation of direct depth [m] per bin (N).
  Eigen::VectorXd sigma_m(const OperatingPoint& point, double ratio, double delay_m) const;
  Eigen::VectorXd tail_sigma_m(const OperatingPoint& point, const ExponentialTail& tail) const;
  /// Mean over depth of sqrt(2 / pi) sigma [m], limited to range / 4.
  double mae_m(const Eigen::VectorXd& sigma_m) const;

 private:
  Eigen::VectorXd sigma_of(const OperatingPoint& point, double ratio, const Eigen::MatrixXd& later,
                           Eigen::Index shift, bool delay_is_known) const;

  int samples_;
  double range_m_;
  Eigen::MatrixXd readout_, table_;  // T o chi of the tap values
  Eigen::VectorXd ambient_, shot_ambient_, floor_variance_e2_;
  Eigen::VectorXd masses_;  // share of depths in each bin; empty: uniform
};

/// Bias of single-path decoding with a second return that is closer than the features of the
/// correlation functions: r delta / (1 + r) [m].
double single_path_bias_m(double ratio, double delay_m);

}  // namespace tofsmith
