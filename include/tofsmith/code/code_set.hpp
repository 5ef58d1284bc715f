// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

namespace tofsmith {

/// Interval [rise, fall) in which a binary waveform is on, in periods: 0 <= rise < 1 and rise <
/// fall <= rise + 1. It may extend past the end of the period.
struct OnInterval {
  double rise = 0.0;
  double fall = 0.0;
  friend bool operator==(const OnInterval&, const OnInterval&) = default;
};

/// Periodic piecewise constant signal: values[i] on [breakpoints[i], breakpoints[i + 1]), in
/// periods. The last value extends to the first breakpoint.
struct StepFunction {
  std::vector<double> breakpoints;
  std::vector<double> values;
};

/// One period of a modulation or demodulation function. Binary waveforms are stored as switching
/// times and sums of cosines as Fourier coefficients; other waveforms as N samples, each constant
/// over its cell [n, n + 1)/N.
class Waveform {
 public:
  /// `level` inside the intervals, 0 elsewhere.
  /// @throws InvalidArgument unless intervals are sorted, disjoint and within the period, and level
  ///         is finite and > 0
  static Waveform binary(std::vector<OnInterval> on, double level = 1.0);
  /// @throws InvalidArgument if empty or not finite
  static Waveform sampled(Eigen::VectorXd samples);
  /// x(t) = c_0 + 2 Re sum_n c_n exp(2 pi i n t).
  /// @param coefficients  c_0 (real), c_1, ...
  /// @throws InvalidArgument if empty, not finite or with more than 2^16 harmonics
  static Waveform cosines(Eigen::VectorXcd coefficients);
  /// mean + amplitude cos(2 pi frequency t - phase_rad).
  static Waveform cosine(int frequency, double mean, double amplitude, double phase_rad);
  static Waveform constant(double level);
  /// On where samples exceed `threshold`, a fraction of the maximum.
  static Waveform binary_from_samples(const Eigen::VectorXd& samples, double level,
                                      double threshold = 0.5);

  bool is_binary() const { return samples_.size() == 0 && coefficients_.size() == 0; }
  bool is_sampled() const { return samples_.size() > 0; }
  /// Empty unless is_binary().
  const std::vector<OnInterval>& on_intervals() const { return on_; }
  /// Value of a binary waveform while on.
  double level() const { return level_; }
  /// Samples (N); empty unless is_sampled().
  const Eigen::VectorXd& samples() const { return samples_; }
  /// c_0, c_1, ... of a sum of cosines; else empty.
  const Eigen::VectorXcd& coefficients() const { return coefficients_; }

  double mean() const;
  double minimum() const;
  double peak() const;
  /// Share of the period above half the peak; exact if binary.
  double duty() const;
  /// Number of jumps in one period; 0 for a sum of cosines.
  int edges() const;
  /// Repetitions per period: the greatest common divisor of the harmonics, at least 1.
  int repetitions() const;

  /// Means over N cells, as output by a generator with N samples.
  Eigen::VectorXd cell_averages(int samples) const;
  /// c_n = integral of x(t) exp(-2 pi i n t) dt, n = 0 to `highest`.
  Eigen::VectorXcd harmonics(int highest) const;
  /// Averages a sum of cosines over at least 64 cells per period of its highest harmonic.
  StepFunction steps() const;
  /// a + b x(t), for waveforms that are not binary.
  Waveform scaled(double a, double b) const;
  /// Values at the centres of N equal cells.
  Eigen::VectorXd values_at_middles(int points) const;

  /// @throws InvalidArgument if a sampled waveform would be delayed by a fraction of a sample
  Waveform delayed(double periods) const;
  /// 1 - x, the gain of the other bucket. x must be in [0, 1], with level 1 if binary.
  Waveform complement() const;

  friend bool operator==(const Waveform& a, const Waveform& b);

 private:
  std::vector<OnInterval> on_;
  double level_ = 0.0;
  Eigen::VectorXd samples_;
  Eigen::VectorXcd coefficients_;
};

/// Pulse [begin, begin + duty) of unit mean power: level 1/duty.
Waveform rectangular_pulse(double duty, double begin = 0.0);

/// Equal pulses of total duty `duty` and unit mean power.
Waveform pulse_train(int count, double duty);

/// `frequency` cycles per period, each on for its first half, from `begin` [periods].
Waveform square_wave(int frequency, double begin);

inline constexpr int max_exposure_rows = 16;

/// Origin of a code; stored in its file, without effect on the code.
struct Provenance {
  std::string method;             ///< family, factorize, ...
  std::string camera;             ///< name
  std::uint64_t seed = 0;         ///< of the search
  std::string version;            ///< of tofsmith
  std::vector<double> residuals;  ///< rms distance from the target, per measurement; may be empty
  double depth_error_m = 0.0;     ///< by which it was selected; 0: not evaluated
};

/// A set of coding functions: E modulation functions, one per exposure, and K = E x taps
/// demodulation functions. Measurement i belongs to exposure i / taps and tap i % taps.
///
/// Modulation is emitted power over average power, >= 0, with a mean of at most 1. Demodulation is
/// one of
/// - sensor gain: in [0, 1]; the taps of an exposure add up to at most 1
/// - mixer weight of a signed code: in [-1, 1], one per exposure; stored as the drive x in [0, 1],
///   with weight 2 x - 1
/// - rows of one exposure: K weighted sums of the light in N time bins; any values
class CodeSet {
 public:
  /// @throws InvalidArgument naming the waveform and the rule
  static CodeSet create(std::string name, int samples, int taps, std::vector<Waveform> modulation,
                        std::vector<Waveform> demodulation);

  /// Creates rows of one exposure: weighted sums of the same light.
  /// @param rows  (N, K): weights of any sign and scale, none all zero
  /// @throws InvalidArgument naming light or row and the rule
  static CodeSet create_rows(std::string name, Waveform light, const Eigen::MatrixXd& rows);
  /// As above from N samples of light, normalized to mean 1, and rows (N, K) or (K, N).
  static CodeSet create_rows(std::string name, const Eigen::VectorXd& light, Eigen::MatrixXd rows);

  /// Creates a signed code from weights of a mixer (N, E); weights of only -1 or 1 become switching
  /// times.
  /// @throws InvalidArgument naming the waveform and the rule
  static CodeSet create_signed(std::string name, std::vector<Waveform> modulation,
                               const Eigen::MatrixXd& weights);

  const std::string& name() const { return name_; }
  int samples() const { return samples_; }
  int taps() const { return taps_; }  ///< taps per exposure, or number of rows
  bool is_rows() const { return is_rows_; }
  /// Returns true for a mixer.
  bool is_signed() const { return is_signed_; }
  int exposures() const { return static_cast<int>(modulation_.size()); }
  int measurements() const { return static_cast<int>(demodulation_.size()); }
  int exposure_of(int measurement) const { return measurement / taps_; }

  const Waveform& modulation(int exposure) const {
    return modulation_[static_cast<std::size_t>(exposure)];
  }
  /// For a signed code, the drive in [0, 1].
  const Waveform& demodulation(int measurement) const {
    return demodulation_[static_cast<std::size_t>(measurement)];
  }
  /// First exposure of each run of exposures with the same modulation, i.e. of each frequency.
  std::vector<int> frequency_starts() const;
  const Waveform& modulation_of(int measurement) const {
    return modulation(exposure_of(measurement));
  }

  bool is_binary() const;
  /// Peak factor that the code requires.
  double peak() const;
  /// Cell averages, (N, E).
  Eigen::MatrixXd modulation_samples() const;
  /// Cell averages, (N, K): gains, weights in [-1, 1], or rows.
  Eigen::MatrixXd demodulation_samples() const;

  CodeSet renamed(std::string name) const;
  /// Changes only the number of samples, not the waveforms.
  CodeSet resampled(int samples) const;
  /// Moves the origin of depth: correlation'(z) = correlation(z + rotation_bin).
  CodeSet rotated(int rotation_bin) const;
  /// Sets the share of the total integration time of each exposure.
  /// @param shares  > 0, of sum 1; empty: equal shares
  /// @throws InvalidArgument naming the share and the rule
  CodeSet with_exposure_shares(std::vector<double> shares) const;
  /// Returns the same code with its exposures, and all that belongs to them, in another order.
  /// @param order  present number of each new exposure: a permutation of 0, 1, ...
  /// @throws InvalidArgument naming the rule
  CodeSet with_exposure_order(const std::vector<int>& order) const;
  /// Empty: equal shares.
  const std::vector<double>& exposure_shares() const { return exposure_shares_; }

  /// Adds the complement of every demodulation.
  /// @throws InvalidArgument unless taps() == 1
  CodeSet with_two_buckets() const;
  /// Replaces every gain d by the mixer weight 2 d - 1, the difference of two buckets d and 1 - d.
  /// @throws InvalidArgument unless taps() == 1
  CodeSet with_signed_weights() const;
  /// Convert between a signed code and a code of two complementary buckets.
  /// @throws InvalidArgument for other codes
  CodeSet signed_of_buckets() const;
  CodeSet buckets_of_signed() const;

  Provenance provenance;

 private:
  CodeSet() = default;
  std::string name_;
  int samples_ = 0;
  int taps_ = 1;
  bool is_rows_ = false, is_signed_ = false;
  std::vector<Waveform> modulation_;
  std::vector<Waveform> demodulation_;
  std::vector<double> exposure_shares_;
};

}  // namespace tofsmith
