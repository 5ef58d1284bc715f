// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Fisher information on the delay of light if photons are recorded individually. The light is
/// blurred by one or both arms of the camera (light source and sensor), with a given transfer
/// function.
/// @see docs/bounds.md
class PhotonInformation {
 public:
  /// @param transfer  harmonics 0, 1, ... of the blur
  /// @param may_ring  the response itself may be negative, e.g. if measured; otherwise negative
  ///                  values are attributed to missing harmonics
  PhotonInformation(const Eigen::VectorXcd& transfer, bool may_ring);

  /// Returns the integral over the period of (s x')^2 / (s x + other), with x the response of the
  /// arms. This is an upper limit on the information for any light of mean at most 1. It is
  /// infinite unless s x + other > 0.
  /// @param signal_e  s, electrons of the light
  /// @param other_e   variance of everything else that is collected together with the light
  double of_impulses(double signal_e, double other_e) const;
  /// Returns an upper limit on s^2 / other times the mean of x'^2. It holds for any light within
  /// [0, peak_factor] with mean at most 1.
  double of_ripple(double signal_e, double other_e, double peak_factor) const;
  /// Returns the smaller of of_impulses() and of_ripple().
  double largest(double signal_e, double other_e, double peak_factor) const;

  /// max (2 pi n |H_n|)^2.
  double largest_slope_power() const { return largest_slope_power_; }
  /// Returns the largest magnitude of negative values that light has after the arms have blurred
  /// it, for any light within [0, peak_factor] with mean at most 1. This is 0 unless the response
  /// itself has negative values.
  double undershoot(double peak_factor) const;

 private:
  Eigen::VectorXd response_, slope_;  // over one period
  bool may_ring_;
  double largest_slope_power_ = 0.0;
};

/// Upper limit on the information that one tap provides on a delay. It holds for any light of mean
/// at most 1 and any gate, 0 <= d <= 1. It depends on the number of electrons x that the gate
/// passes in an exposure. For a gate d(t) that passes x electrons of the light l(t) = s g + a,
/// where g is the response of the arms,
///   |slope of x| <= Phi(x) = max of integral d l',
///   |curvature of x| <= Psi(x) = max of integral d l''
/// over all gates with integral d l = x. The maximum is attained by gates that open where l'/l is
/// largest (Neyman-Pearson).
/// @see docs/bounds.md
class GateInformation {
 public:
  /// @param transfer  harmonics 0, 1, ... of the blur; its response must not ring
  explicit GateInformation(const Eigen::VectorXcd& transfer);

  /// Returns max Phi^2 / (x + other), an upper limit on the information [1 / period^2] at any
  /// depth.
  /// @param signal_e  s, electrons of the light if the gate were always open
  /// @param ambient_e  a, the same for ambient light
  /// @param other_e2  variance without light
  double at_any_depth(double signal_e, double ambient_e, double other_e2) const;

  /// Returns a tighter limit for the mean over all depths. x rises and falls with depth. Between
  /// two turning points a and b, the squared slope of x, z(x), is at most Phi^2. It is 0 at both
  /// ends, and its own slope is at most 2 Psi. The mean of z / (x + other) is therefore at most the
  /// maximum over a and b of
  ///   integral sqrt(z) / (x + other) dx  /  integral dx / sqrt(z)   from a to b.
  double mean_over_depths(double signal_e, double ambient_e, double other_e2) const;

 private:
  Eigen::ArrayXd response_, slope_, curvature_;  // over one period, equidistant
};

/// Returns the integral over the period of (s x')^2 / (s x + other) for equidistant samples of x
/// and x'.
double information_of_shape(const Eigen::VectorXd& shape, const Eigen::VectorXd& slope,
                            double signal_e, double other_e);

/// Evaluates a real signal and its slope per period at 4 n points, from harmonics 0 to n.
void sample_with_slope(const Eigen::VectorXcd& harmonics, Eigen::VectorXd& values,
                       Eigen::VectorXd& slope);

/// Information counted by a Cramer-Rao bound.
enum class NoiseInformation {
  mean,               ///< of the expected measurements, weighted by 1 / variance
  mean_and_variance,  ///< also from the noise level (less than 0.1 % more)
};

/// Cramer-Rao bound on depth for one code; signal and ambient light unknown.
/// @see docs/bounds.md
class CramerRaoBound {
 public:
  /// Depths are the centres of equal cells; slopes are means over a cell.
  /// @param camera         the camera of `model`
  /// @param cells_per_bin  default: 4, or more if the highest harmonics require it
  CramerRaoBound(const ForwardModel& model, const Camera& camera,
                 NoiseInformation information = NoiseInformation::mean,
                 std::optional<int> cells_per_bin = std::nullopt);

  /// Smallest standard deviation of unbiased estimators [m] at the depth of each cell: the root of
  /// the depth entry of the inverse Fisher matrix over (depth, S, A), with variance mu_i + constant
  /// variance. Infinite if depth cannot be separated from signal and ambient light.
  Eigen::VectorXd sigma_m(const OperatingPoint& point) const;
  /// Mean over depth, weighted by the camera's distribution of depths, of sqrt(2 / pi) sigma, the
  /// mean absolute value of a normal deviation [m].
  double mae_m(const OperatingPoint& point) const;
  /// As above, averaged over a signal scaled uniformly in (0, 1). At each albedo the bound is
  /// limited to range / 4, the mean circular error of a guess; otherwise the average diverges.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  NoiseInformation information_;
  // Electrons per unit of S (cells, K) and of A (K), for measurements and for the light that causes
  // their shot noise; slopes per period.
  Eigen::MatrixXd signal_, signal_slope_, shot_signal_, shot_signal_slope_;
  Eigen::VectorXd ambient_, shot_ambient_;
  Eigen::VectorXd constant_variance_e2_;
  Eigen::VectorXd masses_;  // share of depths in each cell; empty: uniform
  /// For rows, whose noise is correlated: covariance at the same depths, and its slope.
  std::optional<RowCovariance> covariance_;
  Eigen::MatrixXd covariance_slope_;

  Eigen::Matrix<double, Eigen::Dynamic, 3> whitened_jacobian(Eigen::Index depth,
                                                             const OperatingPoint& point) const;
  Eigen::Matrix<double, Eigen::Dynamic, 3> whitened_jacobian_of_rows(
      Eigen::Index depth, const OperatingPoint& point) const;
};

/// Bound for unbiased estimators that observe all N time bins of an exposure with the light of a
/// code of rows (Readout::rows). It is below the CramerRaoBound of any rows for this light. Signal
/// and ambient light are unknown, and there is no read noise.
class HistogramBound {
 public:
  /// @param camera  the camera of `model`
  /// @throws std::invalid_argument unless model.has_rows()
  HistogramBound(const ForwardModel& model, const Camera& camera);

  /// Mean over depth of sqrt(2 / pi) sigma [m]; all bins are equivalent.
  double mae_m(const OperatingPoint& point) const;
  /// Averaged over a signal scaled uniformly in (0, 1), limited to range / 4 at each albedo.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  Eigen::MatrixXd light_, slope_;  // electrons of all bins per unit of S, (N, depths in a bin)
  Eigen::VectorXd masses_;         // share of depths at each position in a bin; empty: uniform
  double ambient_e_ = 0.0, dark_e_ = 0.0;  // per bin
};

/// Lower limit on the circular error of any code on a camera, for a given number of exposures,
/// derived from the harmonics that the camera's arms pass; 0 without impulse responses. For rows,
/// photons are recorded individually without read noise.
/// @see docs/bounds.md for derivation and assumptions
class ReceiverBound {
 public:
  /// @param exposures  E >= 1
  /// @throws std::invalid_argument if the camera is invalid
  ReceiverBound(const Camera& camera, int exposures);

  /// Upper limit on the mean over depth of the information [1 / period^2] that taps can gather. It
  /// follows from the harmonic with the largest slope that the arms pass, and from the power that a
  /// gate of duty kappa can have in harmonics. If depths are not uniform, it is multiplied by their
  /// largest density relative to uniform depths.
  double tap_information(const OperatingPoint& point) const;
  /// As above for photons recorded individually behind both arms, with one read-out per exposure
  /// (two if measurements are differences). It is the smallest of three limits: from the arms'
  /// response, from the largest ripple within the peak, and from GateInformation::at_any_depth().
  double photon_information(const OperatingPoint& point) const;
  /// As above for photons that pass gates, which do not record arrival times; from
  /// GateInformation::mean_over_depths(). Infinite for rows, for mixers with analog weights and for
  /// measured responses, which may ring.
  double gate_information(const OperatingPoint& point) const;
  /// Smallest of these limits.
  double information(const OperatingPoint& point) const;

  /// Lower limit on the mean circular error [m] of any estimator, biased or not, with S and A
  /// known; includes wraps and confused depths. It is the Ziv-Zakai bound computed from
  /// information() and from the largest distance, in standard deviations, that taps can achieve
  /// between the measurements of any two depths. It is range / 4 without light, and about range
  /// sqrt(2 / pi) / sqrt(information) in bright light. If depths are not uniform, the latter is
  /// used at all light levels. The bound is 0 without impulse responses.
  double mae_m(const OperatingPoint& point) const;
  /// Averaged over a signal scaled uniformly in (0, 1), limited to range / 4 at each albedo.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  int taps_;
  bool has_rows_;
  bool drain_;
  int read_outs_;  // least number per measurement
  double peak_factor_;
  double sensitivity_;  // of the most sensitive tap
  double dark_e_per_s_;
  double constant_variance_e2_;
  double max_density_;                        // of depths, relative to uniform
  std::vector<double> exposure_s_;            // of each exposure
  std::optional<PhotonInformation> photons_;  // behind both arms; none if unlimited
  std::optional<GateInformation> gates_;      // as photons_; none if rows or ringing
  Eigen::VectorXd transfer_power_;            // |H|^2 of both arms at harmonics 1, 2, ...

  double gathered(const OperatingPoint& point) const;
  double recorded_information(const OperatingPoint& point, bool by_gates) const;
};

/// Bound set by the light alone, for comparison: an ideal direct time-of-flight receiver that
/// records individual photons, with the camera's light source and total exposure time (no
/// demodulation, read noise or dark current). Signal and ambient light are known.
///   J <= T integral over the period of (S m')^2 / (S m + A) du
/// No receiver does better with the same light. This bound therefore never exceeds ReceiverBound,
/// except possibly for a measured sensor response that rings.
/// @see docs/bounds.md for derivation and assumptions
class DirectTofBound {
 public:
  /// @throws std::invalid_argument if the camera is invalid
  explicit DirectTofBound(const Camera& camera);

  /// Upper limit for any modulation within the camera's peak and average power [1 / period^2];
  /// infinite if the light has no impulse response.
  double photon_information(const OperatingPoint& point) const;
  /// If depths are uniform: the Ziv-Zakai bound [m], which is range / 4 without light. Otherwise:
  /// range sqrt(2 / pi) / sqrt(photon_information).
  double mae_m(const OperatingPoint& point) const;
  /// Averaged over a signal scaled uniformly in (0, 1), limited to range / 4 at each albedo.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

  /// Exact information of one modulation [1 / period^2]; infinite without impulse response.
  double information_of(const Waveform& modulation, const OperatingPoint& point) const;

 private:
  double range_m_;
  double exposure_s_;  // total, times the sensitivity of the best tap
  double peak_factor_;
  double max_density_;                        // of depths, relative to uniform
  Eigen::VectorXcd transfer_;                 // of the light; empty if unlimited
  std::optional<PhotonInformation> photons_;  // behind the light's response; none if unlimited
};

/// Cramer-Rao bound on the direct depth with a second return: from the Fisher matrix over (z,
/// delta, S1, S2, A) of the expected measurements, weighted by their variance, which includes both
/// returns. With a tail of known mean delay: over (z, S1, S2, A).
/// @note decoding two returns is only worthwhile where this is below the bias of single-path
///       decoding
class MultipathBound {
 public:
  /// @param camera  the camera of `model`
  MultipathBound(const ForwardModel& model, const Camera& camera);

  /// Smallest standard deviation of direct depth [m], at the centre of each bin (N).
  Eigen::VectorXd sigma_m(const OperatingPoint& point, double ratio, double delay_m) const;
  Eigen::VectorXd tail_sigma_m(const OperatingPoint& point, const ExponentialTail& tail) const;
  /// Mean over depth of sqrt(2 / pi) sigma [m], limited at each depth to range / 4, the mean
  /// circular error of a guess.
  double mae_m(const Eigen::VectorXd& sigma_m) const;

 private:
  Eigen::VectorXd sigma_of(const OperatingPoint& point, double ratio, const Eigen::MatrixXd& later,
                           Eigen::Index shift, bool delay_is_known) const;

  int samples_;
  double range_m_;
  Eigen::MatrixXd readout_, table_;  // T o chi of the tap values, (points, taps)
  Eigen::VectorXd ambient_, shot_ambient_, floor_variance_e2_;
  Eigen::VectorXd masses_;  // share of depths in each bin; empty: uniform
};

/// Bias of single-path decoding with a second return that is closer than the features of the
/// correlation functions: r delta / (1 + r) [m], for any code.
double single_path_bias_m(double ratio, double delay_m);

}  // namespace tofsmith
