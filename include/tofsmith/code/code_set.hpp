// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

namespace tofsmith {

/// One stretch of the unit period in which a binary waveform is on: [rise, fall), in periods,
/// 0 <= rise < 1 and rise < fall <= rise + 1. A stretch may run past the end of the period.
struct OnInterval {
  double rise = 0.0;
  double fall = 0.0;
  friend bool operator==(const OnInterval&, const OnInterval&) = default;
};

/// A periodic signal that is constant between breakpoints: values[i] on
/// [breakpoints[i], breakpoints[i + 1]), in periods; the last value runs on to the first
/// breakpoint.
struct StepFunction {
  std::vector<double> breakpoints;
  std::vector<double> values;
};

/// One period of a modulation or demodulation function. Binary waveforms are stored as switching
/// times and sums of cosines as Fourier coefficients, both independent of any grid; all other
/// waveforms as N samples, each held over its cell [n, n + 1)/N.
class Waveform {
 public:
  /// `level` inside the intervals, 0 elsewhere.
  /// @throws std::invalid_argument unless intervals are sorted, disjoint and within the period,
  ///         and level is finite and > 0
  static Waveform binary(std::vector<OnInterval> on, double level = 1.0);
  /// @throws std::invalid_argument if empty or not finite
  static Waveform sampled(Eigen::VectorXd samples);
  /// x(t) = c_0 + 2 Re sum_n c_n exp(2 pi i n t): a finite sum of cosines.
  /// @param coefficients  c_0 (real), c_1, ...
  /// @throws std::invalid_argument if empty, not finite or with more than 2^16 harmonics
  static Waveform cosines(Eigen::VectorXcd coefficients);
  /// mean + amplitude cos(2 pi frequency t - phase_rad).
  static Waveform cosine(int frequency, double mean, double amplitude, double phase_rad);
  /// Never on (level 0) or always on.
  static Waveform constant(double level);
  /// Reads samples as switching times: on where above `threshold` (a fraction of the maximum).
  static Waveform binary_from_samples(const Eigen::VectorXd& samples, double level,
                                      double threshold = 0.5);

  bool is_binary() const { return samples_.size() == 0 && coefficients_.size() == 0; }
  bool is_sampled() const { return samples_.size() > 0; }
  /// Switching times; empty for a sampled waveform.
  const std::vector<OnInterval>& on_intervals() const { return on_; }
  /// Value while on, of a binary waveform.
  double level() const { return level_; }
  /// Samples (N); empty unless is_sampled().
  const Eigen::VectorXd& samples() const { return samples_; }
  /// Fourier coefficients c_0, c_1, ... of a sum of cosines; empty for other waveforms.
  const Eigen::VectorXcd& coefficients() const { return coefficients_; }

  double mean() const;
  double minimum() const;
  double peak() const;
  /// Share of the period in which the waveform is above half its peak; exact for binary ones.
  double duty() const;
  /// Number of jumps in one period; 0 for a sum of cosines.
  int edges() const;
  /// Number of times that the waveform repeats in one period: the greatest common divisor of its
  /// harmonics, at least 1.
  int repetitions() const;

  /// Means over N cells of the period: what a generator with N samples plays. Keeps the mean.
  Eigen::VectorXd cell_averages(int samples) const;
  /// Fourier coefficient of the continuous waveform: integral of x(t) exp(-2 pi i n t) over the
  /// unit period.
  Eigen::VectorXcd harmonics(int highest) const;
  /// The waveform as a step function; for a sum of cosines the averages over 64 or more cells per
  /// period of its highest harmonic.
  StepFunction steps() const;
  /// a + b x(t), for a waveform that is not binary.
  Waveform scaled(double a, double b) const;
  /// Values at the middles of N equal cells; for a sampled waveform the sample of that cell.
  Eigen::VectorXd values_at_middles(int points) const;

  /// The waveform, arriving `periods` later. A sampled waveform moves by whole samples only.
  /// @throws std::invalid_argument if a sampled waveform would land between samples
  Waveform delayed(double periods) const;
  /// 1 - x: what the other bucket of a two-bucket sensor collects. x must lie in [0, 1], and a
  /// binary x must have level 1.
  Waveform complement() const;

  friend bool operator==(const Waveform& a, const Waveform& b);

 private:
  std::vector<OnInterval> on_;
  double level_ = 0.0;
  Eigen::VectorXd samples_;
  Eigen::VectorXcd coefficients_;
};

/// A single pulse [0, duty) that emits unit mean power: level 1/duty.
Waveform rectangular_pulse(double duty, double begin = 0.0);

/// `count` equal pulses per period, together on for `duty` of it, of unit mean power.
Waveform pulse_train(int count, double duty);

/// On for half the period, from `begin` [periods], `frequency` times per period.
Waveform square_wave(int frequency, double begin);

/// Most rows of one exposure.
inline constexpr int max_exposure_rows = 16;

/// Where a code comes from; kept in its file, of no effect on the code.
struct Provenance {
  std::string method;             ///< family, factorize, ..
  std::string camera;             ///< name of the camera it was made for
  std::uint64_t seed = 0;         ///< seed of the search that found it
  std::string version;            ///< version of tofsmith that made it
  std::vector<double> residuals;  ///< rms distance from the target, per measurement; may be empty
  double depth_error_m = 0.0;     ///< depth error it was chosen by; 0 = not evaluated
};

/// A set of coding functions: E modulation functions, one per exposure, and K = E x taps
/// demodulation functions. Measurement i belongs to exposure i / taps and tap i % taps.
///
/// Modulation is emitted over average power: values >= 0, mean at most 1.
/// Demodulation is sensor gain: values in [0, 1]; the taps of an exposure never add to more than 1.
/// Of a signed code it is the weight of a mixer, in [-1, 1], one in an exposure. It is kept as the
/// mixer's drive x in [0, 1], which chooses between the signs: the weight is 2 x - 1.
/// Or it is the weights of rows of one exposure, K weighted sums of the light in N time bins: any
/// values, constant over a bin.
class CodeSet {
 public:
  /// @param samples  N, the number of time samples that stand for one period
  /// @throws std::invalid_argument naming the waveform and the rule it breaks
  static CodeSet create(std::string name, int samples, int taps, std::vector<Waveform> modulation,
                        std::vector<Waveform> demodulation);

  /// Rows of one exposure: all K measurements are weighted sums of the same light.
  /// @param rows  (N, K): weights of the time bins, of any sign and scale
  /// @throws std::invalid_argument naming light or row and the rule it breaks; none of them may be
  ///         all zero
  static CodeSet create_rows(std::string name, Waveform light, const Eigen::MatrixXd& rows);
  /// The same of arrays of others: N samples of light of any scale, made one of mean 1, and rows
  /// (N, K) or (K, N).
  static CodeSet create_rows(std::string name, const Eigen::VectorXd& light, Eigen::MatrixXd rows);

  /// A signed code: weights of a mixer, (N, E), of which those that are -1 or 1 throughout become
  /// switching times.
  /// @throws std::invalid_argument naming the waveform and the rule it breaks
  static CodeSet create_signed(std::string name, std::vector<Waveform> modulation,
                               const Eigen::MatrixXd& weights);

  const std::string& name() const { return name_; }
  int samples() const { return samples_; }
  int taps() const { return taps_; }  ///< or rows
  /// Whether the measurements are rows of one exposure.
  bool is_rows() const { return is_rows_; }
  /// Whether the demodulation is that of a mixer.
  bool is_signed() const { return is_signed_; }
  int exposures() const { return static_cast<int>(modulation_.size()); }
  int measurements() const { return static_cast<int>(demodulation_.size()); }
  int exposure_of(int measurement) const { return measurement / taps_; }

  /// Modulation function of one exposure.
  const Waveform& modulation(int exposure) const {
    return modulation_[static_cast<std::size_t>(exposure)];
  }
  /// Demodulation function of one measurement; of a signed code its drive, in [0, 1].
  const Waveform& demodulation(int measurement) const {
    return demodulation_[static_cast<std::size_t>(measurement)];
  }
  /// First exposure of each frequency, which is a run of exposures with the same modulation.
  std::vector<int> frequency_starts() const;
  /// Modulation that measurement i sees.
  const Waveform& modulation_of(int measurement) const {
    return modulation(exposure_of(measurement));
  }

  /// Largest modulation value of all exposures: the peak factor the code needs.
  double peak() const;
  /// Cell averages of the modulation functions, (N, E).
  Eigen::MatrixXd modulation_samples() const;
  /// Cell averages of the demodulation functions, (N, K): gains, weights in [-1, 1], or rows.
  Eigen::MatrixXd demodulation_samples() const;

  CodeSet renamed(std::string name) const;
  /// The same code on another number of samples; waveforms do not change.
  CodeSet resampled(int samples) const;
  /// Moves the origin of depth: correlation'(z) = correlation(z + rotation_bin). Every modulation
  /// is delayed by rotation_bin samples.
  CodeSet rotated(int rotation_bin) const;
  /// For a two-bucket sensor: the complement of every demodulation is read out of the same
  /// exposure. @throws std::invalid_argument unless taps() == 1
  CodeSet with_two_buckets() const;
  /// For a mixer: every gain d becomes the drive of the weight 2 d - 1, which is what two buckets
  /// with d and 1 - d measure as their difference. @throws std::invalid_argument unless taps() == 1
  CodeSet with_signed_weights() const;
  /// The code of two buckets of which each second is what the first leaves, as one of a mixer, and
  /// back. @throws std::invalid_argument unless it is such a code
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
};

}  // namespace tofsmith
