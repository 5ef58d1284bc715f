// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/camera/forward_model.hpp"

namespace tofsmith {

/// Information on the delay of a light of given shape behind arms of one transfer function, where
/// photons are recorded one by one.
/// @see docs/bounds.md
class PhotonInformation {
 public:
  /// @param transfer  harmonics 0 .. highest of what blurs the light
  /// @param may_ring  whether the response itself may fall below 0, as a measured one may; else
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

/// How much one tap can learn of a delay from how many electrons a gate passes in an exposure,
/// whatever the gate (0 <= d <= 1) and the light (mean at most 1). A gate that passes x electrons
/// of l(t) = s g + a, g the arms' response, has
///   |slope of x| <= Phi(x) = max of integral d l',  |curvature of x| <= Psi(x) = .. d l''
/// over all gates with integral d l = x: those that open where l'/l is largest (Neyman-Pearson).
/// @see docs/bounds.md
class GateInformation {
 public:
  /// @param transfer  harmonics 0 .. highest of what blurs the light; its response must not ring
  explicit GateInformation(const Eigen::VectorXcd& transfer);

  /// max Phi^2 / (x + other): no depth has more information [1 / period^2].
  /// @param signal_e  s, electrons of the light if the gate were always open
  /// @param ambient_e  a, the same of ambient light
  /// @param other_e2  variance without light
  double at_any_depth(double signal_e, double ambient_e, double other_e2) const;

  /// The mean over all depths cannot be as large: x comes and goes. Between two depths where it
  /// turns, a and b, its squared slope z(x) is at most Phi^2 and starts and ends at 0 with a slope
  /// of at most 2 Psi, so that the mean of z / (x + other) is at most, over all a and b,
  ///   integral sqrt(z) / (x + other) dx  /  integral dx / sqrt(z)   from a to b.
  double mean_over_depths(double signal_e, double ambient_e, double other_e2) const;

 private:
  Eigen::ArrayXd response_, slope_, curvature_;  // over one period, at equal distances
};

/// Integral over the period of (s x')^2 / (s x + other), x and x' sampled at equal distances.
double information_of_shape(const Eigen::VectorXd& shape, const Eigen::VectorXd& slope,
                            double signal_e, double other_e);

/// A real signal and its slope per period, from harmonics 0 .. highest, at 4 x highest points.
void sample_with_slope(const Eigen::VectorXcd& harmonics, Eigen::VectorXd& values,
                       Eigen::VectorXd& slope);

/// Which information a Cramer-Rao bound counts.
enum class NoiseInformation {
  mean,               ///< of the expected measurements, weighted by 1 / variance
  mean_and_variance,  ///< also of the size of the noise (under 0.1 % more)
};

/// How well any unbiased estimator can measure depth with one code, signal and ambient unknown.
/// @see docs/bounds.md
class CramerRaoBound {
 public:
  /// Depths are the middles of equal cells; slopes are means over a cell.
  /// @param camera         the one `model` was made with
  /// @param cells_per_bin  none: 4, or as many more as the highest harmonics need
  CramerRaoBound(const ForwardModel& model, const Camera& camera,
                 NoiseInformation information = NoiseInformation::mean,
                 std::optional<int> cells_per_bin = std::nullopt);

  /// Smallest standard deviation [m] at the depth of each cell: the root of the depth entry of the
  /// inverse Fisher matrix over (depth, S, A), variance mu_i + constant variance. Infinite where
  /// depth cannot be separated from signal and ambient.
  Eigen::VectorXd sigma_m(const OperatingPoint& point) const;
  /// Mean over depth, as the camera weighs depths, of sqrt(2 / pi) sigma: the mean absolute error
  /// of a normal deviation [m].
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1); at each albedo held to range / 4,
  /// the mean circular error of a guess, without which the average diverges.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  NoiseInformation information_;
  // Electrons per unit of S (cells, K) and of A (K), of measurements and of the light they are made
  // of; slopes per period.
  Eigen::MatrixXd signal_, signal_slope_, shot_signal_, shot_signal_slope_;
  Eigen::VectorXd ambient_, shot_ambient_;
  Eigen::VectorXd constant_variance_e2_;
  Eigen::VectorXd masses_;  // share of depths in each cell; empty: all alike
  /// Of rows, whose noise is correlated: at the same depths, and its slope.
  std::optional<RowCovariance> covariance_;
  Eigen::MatrixXd covariance_slope_;

  Eigen::Matrix<double, Eigen::Dynamic, 3> whitened_jacobian(Eigen::Index depth,
                                                             const OperatingPoint& point) const;
  Eigen::Matrix<double, Eigen::Dynamic, 3> whitened_jacobian_of_rows(
      Eigen::Index depth, const OperatingPoint& point) const;
};

/// How well any unbiased estimator can measure depth that sees all N time bins of the exposure,
/// with the light of rows: below the CramerRaoBound of all rows of that light, whatever their
/// weights. Without read noise; signal and ambient unknown.
class HistogramBound {
 public:
  /// @param camera  the one `model` was made with
  /// @throws std::invalid_argument unless model.has_rows()
  HistogramBound(const ForwardModel& model, const Camera& camera);

  /// Mean over depth of sqrt(2 / pi) sigma [m]; every bin is alike.
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1), at each albedo held to range / 4.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  Eigen::MatrixXd light_, slope_;  // electrons of all bins per unit of S, (N, depths in a bin)
  Eigen::VectorXd masses_;         // share of depths at each of those in a bin; empty: all alike
  double ambient_e_ = 0.0, dark_e_ = 0.0;  // of every bin
};

/// How well any code at all can do on a camera, in a number of exposures: below the circular error
/// of every code whose harmonics the camera's arms limit; 0 without impulse responses. Of rows,
/// what photons recorded one by one tell, without read noise.
/// @see docs/bounds.md for derivation and assumptions
class ReceiverBound {
 public:
  /// @param exposures  E >= 1
  /// @throws std::invalid_argument if the camera is invalid
  ReceiverBound(const Camera& camera, int exposures);

  /// Mean over depth of the largest information on depth [1 / period^2] that taps can gather: from
  /// the largest harmonic the arms let through and from how much a gate of duty kappa can hold.
  /// Where depths are not alike, as many times that as the most frequent occur more often.
  double tap_information(const OperatingPoint& point) const;
  /// The same for photons recorded one by one behind both arms, one read-out per exposure (two
  /// where each measurement is a difference of two), from the arms' response itself or from the
  /// largest ripple within the peak, and for those that any gate makes of them: the least of these.
  double photon_information(const OperatingPoint& point) const;
  /// The mean over depth of what any gate makes of photons while the light passes it: infinite for
  /// rows and for measured responses, which may ring.
  double gate_information(const OperatingPoint& point) const;
  /// The least of all.
  double information(const OperatingPoint& point) const;

  /// Mean circular error [m] below which no estimator comes, biased or not, wraps and confused
  /// depths included: the Ziv-Zakai bound from how far apart taps can keep any two depths and from
  /// information(), S and A known. range / 4 without light, range sqrt(2 / pi) / sqrt(information)
  /// in much of it, and that at all where depths are not alike; 0 without impulse responses.
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1), at each albedo held to range / 4.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

 private:
  double range_m_;
  int taps_;
  bool has_rows_;
  bool drain_;
  int read_outs_;  // of an exposure that no measurement is without
  double peak_factor_;
  double sensitivity_;  // of the most sensitive tap
  double dark_e_per_s_;
  double constant_variance_e2_;
  double max_density_;                        // of depths, over that of uniform ones
  std::vector<double> exposure_s_;            // of each exposure
  std::optional<PhotonInformation> photons_;  // behind both arms; none without limit
  std::optional<GateInformation> gates_;      // the same; none of rows and of what may ring
  Eigen::VectorXd transfer_power_;            // |H|^2 of both arms at harmonics 1 ..

  double gathered(const OperatingPoint& point) const;
  double recorded_information(const OperatingPoint& point, bool by_gates) const;
};

/// What the light alone allows, for scale: depth from photons recorded one by one by an ideal
/// direct time-of-flight receiver, with the camera's light source, its total exposure time and
/// nothing else of it (no demodulation, no read noise, no dark current). Signal and ambient are
/// known.
///   J <= T integral over the period of (S m')^2 / (S m + A) du
/// No receiver of any kind does better with the same light, so it is never above ReceiverBound.
/// @see docs/bounds.md for derivation and assumptions
class DirectTofBound {
 public:
  /// @throws std::invalid_argument if the camera is invalid
  explicit DirectTofBound(const Camera& camera);

  /// No modulation within the camera's peak and average power carries more [1 / period^2];
  /// infinite where the light has no impulse response.
  double photon_information(const OperatingPoint& point) const;
  /// range sqrt(2 / pi) / sqrt(photon_information) [m], and range / 4, a guess, without light: the
  /// Ziv-Zakai bound of it, where depths are all alike.
  double mae_m(const OperatingPoint& point) const;
  /// The same averaged over a signal scaled uniformly in (0, 1), at each albedo held to range / 4.
  double mae_uniform_albedo_m(const OperatingPoint& point) const;

  /// What one modulation carries, exactly [1 / period^2]; infinite without impulse response.
  double information_of(const Waveform& modulation, const OperatingPoint& point) const;

 private:
  double range_m_;
  double exposure_s_;  // of all exposures together, times the sensitivity of the best tap
  double peak_factor_;
  double max_density_;                        // of depths, over that of uniform ones
  Eigen::VectorXcd transfer_;                 // of the light; empty if it has no limit
  std::optional<PhotonInformation> photons_;  // behind the light's response; none if no limit
};

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
  Eigen::VectorXd masses_;  // share of depths in each bin; empty: all alike
};

/// Bias of single-path decoding behind a second return, where it is closer than the correlation
/// functions' features: r delta / (1 + r) [m], with every code.
double single_path_bias_m(double ratio, double delay_m);

}  // namespace tofsmith
