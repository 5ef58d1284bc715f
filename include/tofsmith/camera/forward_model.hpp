// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Correlation function of one demodulation and one modulation function, for real depths:
///   chi(u) = integral over the period of (h_d * d)(t) (h_m * m)(t - u) dt,  u in periods.
/// Without impulse responses it is piecewise linear and stored as corners; otherwise it is stored
/// as harmonics D_n Hd_n conj(M_n Hm_n).
/// @see Gutierrez-Barragan et al., CVPR 2019, Eq. (3)
class CorrelationFunction {
 public:
  /// Without impulse responses.
  CorrelationFunction(const Waveform& demodulation, const Waveform& modulation);
  /// With impulse responses. @param transfer  Hd_n conj(Hm_n) for all stored harmonics
  CorrelationFunction(const Waveform& demodulation, const Waveform& modulation,
                      const Eigen::VectorXcd& transfer);

  /// Returns f(u - delay), or f(-(u - delay)) if `reversed`; delay in periods.
  CorrelationFunction moved(double delay, bool reversed) const;

  /// Returns the value at any real `u` [periods].
  double operator()(double u) const;
  /// Returns the values at u = j / points, j = 0 to points - 1.
  Eigen::VectorXd table(int points) const;

  /// Fourier coefficients; empty if corners are stored.
  const Eigen::VectorXcd& harmonics() const { return harmonics_; }
  /// Returns true if the function is piecewise linear with corners at multiples of 1 / points.
  bool has_corners_at(int points) const;

 private:
  CorrelationFunction() = default;

  std::vector<double> corners_;  // in [0, 1), sorted; empty if harmonics are stored
  std::vector<double> values_;   // at the corners
  Eigen::VectorXcd harmonics_;
};

/// Return of light from one depth.
struct Return {
  double signal_e_per_s = 0.0;  ///< S at a gate that is always open
  double depth_bin = 0.0;       ///< in [0, N), any real
};

/// Expected electrons and variances of the measurements of a code on a camera.
///   mu_i(z) = T_i (S chi_i(z) + A kappa_i + dark),  variance mu_i + sigma_r^2 (+ step^2 / 12)
/// chi and kappa follow from the actual waveforms, filtered by both arms. Several returns add.
/// @see Gutierrez-Barragan et al., CVPR 2019, Eq. (4)
///
/// A *tap value* is the charge of one tap; there are E x taps. A *measurement* is a value that the
/// sensor reads out: a tap value, or the difference A - B of two buckets. A mixer with weight w is
/// modelled by two taps, A = (w^2 + w) / 2 and B = (w^2 - w) / 2: A - B is its measurement, and w^2
/// = A + B determines its shot noise. Unless w is -1 or 1, A or B may be negative. For rows, the
/// taps are the N time bins h of the single exposure, and the measurements are y = C^T h, with
/// covariance C^T diag(E h) C plus read noise.
class ForwardModel {
 public:
  /// @throws InvalidArgument for an invalid camera or an unsupported code
  ForwardModel(const CodeSet& code, const Camera& camera);

  int measurements() const { return static_cast<int>(readout_.rows()); }
  int tap_values() const { return static_cast<int>(readout_.cols()); }
  int samples() const { return samples_; }
  int exposures() const { return has_rows() ? 1 : tap_values() / taps_; }
  /// Mean over exposures of the offset of [playback] [m].
  double playback_offset_m() const { return playback_offset_m_; }
  bool has_rows() const { return time_bin_.has_value(); }

  /// Returns chi_i(z) (K).
  Eigen::VectorXd correlation(double depth_bin) const;
  /// Returns chi at depth_bin = j N / points, (points, K).
  Eigen::MatrixXd correlation_table(int points) const;
  /// As correlation_table() for tap values, (points, E x taps).
  Eigen::MatrixXd tap_correlation_table(int points) const;
  /// Highest significant harmonic: higher ones together have less than 3e-7 of the amplitude
  /// without the mean. None for piecewise linear functions.
  std::optional<int> highest_harmonic() const;
  /// Returns the points per bin of a table whose chords approximate the correlation functions:
  /// `least` times a power of two, with an error of at most 5e-4 of the amplitude unless this
  /// requires more than 2^20 points.
  int straight_points_per_bin(int least) const;
  /// Returns true if all functions are piecewise linear with corners at the rows of a table.
  bool has_corners_at_rows(int rows) const;
  /// Returns the light in time bin 0 for rows, (points). Bin n at depth z receives the light of bin
  /// 0 at depth z - n.
  Eigen::VectorXd time_bin_table(int points) const;

  /// kappa_i (K): mean gain seen by ambient light.
  const Eigen::VectorXd& ambient_gain() const { return ambient_gain_; }
  /// kappa of the tap values.
  const Eigen::VectorXd& tap_ambient_gain() const { return tap_ambient_gain_; }
  /// T_i [s] (K).
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }
  /// T of the tap values [s].
  const Eigen::VectorXd& tap_exposure_s() const { return tap_exposure_s_; }
  double tap_dark_e_per_s() const { return tap_dark_e_per_s_; }
  /// Matrix (K, E x taps) from tap values to measurements: +1, -1 and 0, or the weights of rows.
  const Eigen::MatrixXd& readout() const { return readout_; }
  /// Per measurement (K).
  Eigen::VectorXd dark_electrons() const;
  /// Variance without light [e^2] (K): read noise and quantization.
  Eigen::VectorXd constant_variance_e2() const;

  /// Expected tap values [e].
  Eigen::VectorXd expected_tap_electrons(std::span<const Return> returns,
                                         double ambient_e_per_s) const;
  /// Expected measurements [e] (K).
  Eigen::VectorXd expected_electrons(std::span<const Return> returns, double ambient_e_per_s) const;
  /// Variance before clipping [e^2] (K).
  Eigen::VectorXd variance_e2(std::span<const Return> returns, double ambient_e_per_s) const;
  /// Covariance [e^2] (K, K); diagonal unless rows are read out.
  Eigen::MatrixXd covariance_e2(std::span<const Return> returns, double ambient_e_per_s) const;

 private:
  Eigen::VectorXd tap_correlation(double depth_bin) const;
  /// Sums of |c_n|^2 over all functions; empty if one is piecewise linear.
  Eigen::VectorXd harmonic_energies() const;
  void read_rows(const CodeSet& code, const Waveform& light, const Eigen::VectorXcd& transfer,
                 double moved);

  int samples_ = 0;
  int taps_ = 1;
  std::vector<double> contrasts_;
  Eigen::VectorXd sensitivity_;  // 1 without tap_mismatch
  double signal_gain_ = 1.0;     // by the camera's temperature
  double playback_offset_m_ = 0.0;
  double tap_dark_e_per_s_ = 0.0;
  double readout_variance_e2_ = 0.0;             // of a tap value or a row
  std::vector<CorrelationFunction> functions_;   // of the tap values before mixing, or of the rows
  std::optional<CorrelationFunction> time_bin_;  // for rows
  Eigen::VectorXd tap_ambient_gain_, ambient_gain_;
  Eigen::VectorXd tap_exposure_s_, exposure_s_;
  Eigen::MatrixXd readout_;
};

/// Number of harmonics stored for a bandwidth-limited arm with `samples` per period.
int harmonics_kept(int samples);

/// Returns the matrix (K, tap values) from tap values to measurements: each tap value, or A - B of
/// adjacent ones. For rows see ForwardModel::readout().
Eigen::MatrixXd readout_matrix(int tap_values, Readout readout);

/// Number of pairs of K measurements: (0, 0), (1, 0), (1, 1), (2, 0), ...
constexpr int pairs_of(int measurements) { return measurements * (measurements + 1) / 2; }

/// Dependence of the covariance of rows on light, packed by pairs_of(K) [e^2]:
///   cov_ij(z) = S signal(z, ij) + A ambient[ij] + floor[ij]
struct RowCovariance {
  Eigen::MatrixXd
      signal;  ///< T sum_n C_ni C_nj chi_n(z) (points, pairs), row j at z = j N / points
  Eigen::VectorXd ambient;  ///< T sum_n C_ni C_nj / N (pairs)
  Eigen::VectorXd floor;    ///< of dark current and read noise (pairs)

  /// Returns the covariance (K, K) at one row of `signal`.
  Eigen::MatrixXd at(Eigen::Index row, double signal_e_per_s, double ambient_e_per_s) const;
};
/// Computes the covariance of rows.
/// @param points  a multiple of N
/// @throws InvalidArgument unless model.has_rows()
RowCovariance row_covariance(const ForwardModel& model, int points);

/// Variance of a tap value without light [e^2].
double constant_variance_e2_of(const Sensor& sensor);

/// Returns kappa (K) for an estimator on this camera: ambient_gain(), or 0 if ambient light nearly
/// cancels. This applies to rows, and to differences if the brightest operating ambient light
/// changes none of them by more than 5 % of its noise. Estimating so little light would cost a
/// whole measurement.
Eigen::VectorXd unknown_ambient_gain(const ForwardModel& model, const Camera& camera);

/// Exponential tail behind the direct return, as in haze: the light with an additional delay u is
/// ratio / mean exp(-u / mean) times the direct signal, per unit of u.
struct ExponentialTail {
  double mean_delay_m = 0.5;  ///< > 0 and at most the range
  double ratio = 0.3;         ///< signal of the tail / signal of the direct return, >= 0

  /// @throws InvalidArgument
  void validate(double range_m) const;
};

/// Measured response of a scene to a short pulse: histogram of light over distance.
struct Transient {
  std::vector<double> light;  ///< >= 0, any unit; distributes the pixel's signal
  double bin_m = 0.0;         ///< depth per bin, c / 2 times its duration, > 0
  double first_m = 0.0;       ///< beginning of bin 0 behind the pixel's depth

  double total() const;
  /// Returns each non-empty bin as a return at its middle, with its share of `signal_e_per_s`.
  std::vector<Return> returns(double depth_bin, double signal_e_per_s, double camera_bin_m) const;

  /// @throws InvalidArgument unless bins are finite and >= 0 with a sum > 0, and cover at most the
  ///          range
  void validate(double range_m) const;
};

/// Returns the tap values for an exponential tail of unit light, (points, E x taps), row j for a
/// direct return at depth j N / points. Exact for chords between rows.
Eigen::MatrixXd tap_tail_table(const ForwardModel& model, const ExponentialTail& tail,
                               double range_m, int points);

/// Returns the tap values for unit light with the distribution of a transient, (points, E x taps),
/// row j for a pixel at depth j N / points. Exact for chords between rows and constant light within
/// a bin.
Eigen::MatrixXd tap_transient_table(const ForwardModel& model, const Transient& transient,
                                    double range_m, int points);

}  // namespace tofsmith
