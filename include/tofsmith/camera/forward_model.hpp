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

/// The correlation function of one demodulation and one modulation function, for real depth:
///   chi(u) = integral over the period of (h_d * d)(t) (h_m * m)(t - u) dt,  u in periods.
/// Without impulse responses it is piecewise linear and kept exactly by its corners; with them it
/// is smooth and kept by its harmonics D_n Hd_n conj(M_n Hm_n).
/// @see Gutierrez-Barragan et al., CVPR 2019, Eq. (3)
class CorrelationFunction {
 public:
  /// Without impulse responses.
  CorrelationFunction(const Waveform& demodulation, const Waveform& modulation);
  /// With `transfer` = Hd_n conj(Hm_n), n = 0 .. as many harmonics as are to be kept.
  CorrelationFunction(const Waveform& demodulation, const Waveform& modulation,
                      const Eigen::VectorXcd& transfer);

  /// The same `delay` later [periods], and with `reversed` in -u: f(+-(u - delay)).
  CorrelationFunction moved(double delay, bool reversed) const;

  /// Value at depth `u` [periods]; any real u, period 1.
  double operator()(double u) const;
  /// Values at u = j / points, j = 0 .. points - 1.
  Eigen::VectorXd table(int points) const;

  /// Fourier coefficients; empty where corners are stored.
  const Eigen::VectorXcd& harmonics() const { return harmonics_; }
  /// Whether a piecewise linear function has all its corners at multiples of 1 / points.
  bool has_corners_at(int points) const;

 private:
  CorrelationFunction() = default;

  std::vector<double> corners_;  // positions in [0, 1), sorted; empty when harmonics are kept
  std::vector<double> values_;   // at the corners
  Eigen::VectorXcd harmonics_;
};

/// Light that comes back from one depth.
struct Return {
  double signal_e_per_s = 0.0;  ///< S, were the sensor fully open
  double depth_bin = 0.0;       ///< position in [0, N), any real
};

/// What a camera that plays a code measures: expected electrons and their variance.
///   mu_i(z) = T_i (S chi_i(z) + A kappa_i + dark),  variance mu_i + sigma_r^2 (+ step^2 / 12)
/// chi and kappa are those of the actual waveforms, behind both arms.
/// @see Gutierrez-Barragan et al., CVPR 2019, Eq. (4); several returns add.
///
/// A *tap value* is what one tap collects (E x taps of them); a *measurement* is what leaves the
/// sensor (the same, or the differences A - B of two-bucket pairs). Of a mixer with the weight w
/// the two taps of an exposure are A = (w^2 + w) / 2 and B = (w^2 - w) / 2: A - B is what it
/// measures, and A + B the light that makes its shot noise, the square of the weight. A weight that
/// switches is that of two buckets; of others A and B may be negative. Where rows are read out, the
/// taps are the N time bins of the one exposure, and measurements sums of them with the rows'
/// weights: y = C^T h, of covariance C^T diag(E h) C and read noise.
class ForwardModel {
 public:
  /// @throws std::invalid_argument if the camera is invalid or the code does not fit it
  ForwardModel(const CodeSet& code, const Camera& camera);

  int measurements() const { return static_cast<int>(readout_.rows()); }
  int tap_values() const { return static_cast<int>(readout_.cols()); }
  int samples() const { return samples_; }
  int exposures() const { return has_rows() ? 1 : tap_values() / taps_; }
  /// Mean over exposures of the constant that [playback] adds to depth [m].
  double playback_offset_m() const { return playback_offset_m_; }
  /// Whether measurements are rows of one exposure, whose noise is correlated.
  bool has_rows() const { return time_bin_.has_value(); }

  /// chi_i(z) of every measurement (K) at a real depth.
  Eigen::VectorXd correlation(double depth_bin) const;
  /// chi at depth_bin = j N / points, (points, K). points = N gives one row per bin.
  Eigen::MatrixXd correlation_table(int points) const;
  /// The same for the tap values, (points, E x taps).
  Eigen::MatrixXd tap_correlation_table(int points) const;
  /// The highest harmonic that counts: all above together have less than 3e-7 of the amplitude of
  /// all but the mean. None where a correlation function is piecewise linear.
  std::optional<int> highest_harmonic() const;
  /// Points per bin of a table between whose points correlation functions count as straight:
  /// `least` times a power of two, so that chords are off by 5e-4 of the amplitude or less where
  /// 2^20 points suffice for that.
  int straight_points_per_bin(int least) const;
  /// Whether all correlation functions are piecewise linear with corners at the rows of a table.
  bool has_corners_at_rows(int rows) const;
  /// Of rows: light in time bin 0, (points). What bin n sees of depth z, bin 0 sees of z - n.
  Eigen::VectorXd time_bin_table(int points) const;

  /// kappa_i (K): mean gain seen by ambient light.
  const Eigen::VectorXd& ambient_gain() const { return ambient_gain_; }
  /// kappa of the tap values (E x taps).
  const Eigen::VectorXd& tap_ambient_gain() const { return tap_ambient_gain_; }
  /// T_i [s] of every measurement (K).
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }
  /// T of the tap values [s].
  const Eigen::VectorXd& tap_exposure_s() const { return tap_exposure_s_; }
  /// Dark current of every tap value [e/s].
  double tap_dark_e_per_s() const { return tap_dark_e_per_s_; }
  /// Measurements = readout (K, E x taps) times tap values; entries are +1, -1 and 0, or the rows'
  /// weights.
  const Eigen::MatrixXd& readout() const { return readout_; }
  /// Electrons of dark current in every measurement (K).
  Eigen::VectorXd dark_electrons() const;
  /// Variance of every measurement that does not depend on light [e^2] (K): read noise and
  /// quantization.
  Eigen::VectorXd constant_variance_e2() const;

  /// Expected tap values [e].
  Eigen::VectorXd expected_tap_electrons(std::span<const Return> returns,
                                         double ambient_e_per_s) const;
  /// Expected measurements [e] (K).
  Eigen::VectorXd expected_electrons(std::span<const Return> returns, double ambient_e_per_s) const;
  /// Variance of the measurements [e^2] (K), before any clipping.
  Eigen::VectorXd variance_e2(std::span<const Return> returns, double ambient_e_per_s) const;
  /// Covariance of the measurements [e^2] (K, K); diagonal but where rows are read out.
  Eigen::MatrixXd covariance_e2(std::span<const Return> returns, double ambient_e_per_s) const;

 private:
  Eigen::VectorXd tap_correlation(double depth_bin) const;
  /// Sums over all functions of |c_n|^2, n = 0, 1, ...; empty where one is piecewise linear.
  Eigen::VectorXd harmonic_energies() const;
  void read_rows(const CodeSet& code, const Waveform& light, const Eigen::VectorXcd& transfer,
                 double moved);

  int samples_ = 0;
  int taps_ = 1;
  std::vector<double> contrasts_;  // of the exposures
  Eigen::VectorXd sensitivity_;    // of the tap values; 1 but for tap_mismatch
  double signal_gain_ = 1.0;       // by the camera's temperature
  double playback_offset_m_ = 0.0;
  double tap_dark_e_per_s_ = 0.0;
  double readout_variance_e2_ = 0.0;             // constant, of a tap value or a row
  std::vector<CorrelationFunction> functions_;   // of the tap values, before taps mix; of the rows
  std::optional<CorrelationFunction> time_bin_;  // of light in time bin 0, where rows are read out
  Eigen::VectorXd tap_ambient_gain_, ambient_gain_;
  Eigen::VectorXd tap_exposure_s_, exposure_s_;
  Eigen::MatrixXd readout_;
};

/// Harmonics of the correlation function kept for `samples` per period, where an arm is limited.
int harmonics_kept(int samples);

/// What leaves the sensor as sums of tap values, (K, tap values): each by itself, or A - B of every
/// two neighbours. Rows have weights of their own, ForwardModel::readout().
Eigen::MatrixXd readout_matrix(int tap_values, Readout readout);

/// Pairs of K measurements, each with itself too: (0, 0), (1, 0), (1, 1), (2, 0), ..
constexpr int pairs_of(int measurements) { return measurements * (measurements + 1) / 2; }

/// How the covariance of rows depends on light, packed by pairs_of(K) [e^2]:
///   cov_ij(z) = S signal(z, ij) + A ambient[ij] + floor[ij]
struct RowCovariance {
  Eigen::MatrixXd
      signal;  ///< T sum_n C_ni C_nj chi_n(z) (points, pairs), row j at z = j N / points
  Eigen::VectorXd ambient;  ///< T sum_n C_ni C_nj / N (pairs)
  Eigen::VectorXd floor;    ///< of dark current and read noise (pairs)

  /// (K, K) at one row of `signal`.
  Eigen::MatrixXd at(Eigen::Index row, double signal_e_per_s, double ambient_e_per_s) const;
};
/// @param points  a multiple of N
/// @throws std::invalid_argument unless model.has_rows()
RowCovariance row_covariance(const ForwardModel& model, int points);

/// Variance of one tap value that does not depend on light [e^2]: read noise and quantization.
double constant_variance_e2_of(const Sensor& sensor);

/// kappa (K) for an estimator on this camera: 0 for all differences of buckets, and all rows,
/// if the brightest operating ambient leaks into none of them by more than 5 % of its noise, as
/// where a generator rounds duties of 1/2. To estimate such a leak would cost a whole
/// measurement; to ignore it costs next to nothing. Else ambient_gain().
Eigen::VectorXd unknown_ambient_gain(const ForwardModel& model, const Camera& camera);

/// Light that trails off behind the direct return, as in haze or translucent things: after a delay
/// u behind it comes ratio / mean exp(-u / mean) of its signal per unit of u.
struct ExponentialTail {
  double mean_delay_m = 0.5;  ///< [m], > 0 and at most the range of the period
  double ratio = 0.3;         ///< signal of all of the tail over that of the direct return, >= 0

  /// @throws std::invalid_argument naming field, value and rule
  void validate(double range_m) const;
};

/// A measured response of a scene to one short pulse: light by distance, as a histogram.
struct Transient {
  std::vector<double> light;  ///< of each bin, >= 0, any unit; a pixel's signal is shared out so
  double bin_m = 0.0;         ///< depth that one bin takes, c / 2 times its time [m], > 0
  double first_m = 0.0;       ///< depth at which bin 0 begins, behind the pixel's depth [m]

  /// Sum of all bins.
  double total() const;
  /// Every bin as a return at its middle, with its share of `signal_e_per_s`; empty bins left out.
  /// @param depth_bin  of the pixel
  std::vector<Return> returns(double depth_bin, double signal_e_per_s, double camera_bin_m) const;

  /// Finite bins that are not negative, with some light, no longer together than the range.
  /// @throws std::invalid_argument naming bin, value and rule
  void validate(double range_m) const;
};

/// What tap values see of unit light that trails off, (points, E x taps): chi averaged over
/// exponential delays, row j for a direct return at depth j N / points (see
/// ForwardModel::tap_correlation_table), exact for chords between rows.
Eigen::MatrixXd tap_tail_table(const ForwardModel& model, const ExponentialTail& tail,
                               double range_m, int points);

/// What tap values see of unit light spread as a transient, (points, E x taps), row j for a pixel
/// at depth j N / points. The histogram is resampled onto the rows: constant within its bins, exact
/// for chords between rows; it wraps at the period, as the light does.
Eigen::MatrixXd tap_transient_table(const ForwardModel& model, const Transient& transient,
                                    double range_m, int points);

}  // namespace tofsmith
