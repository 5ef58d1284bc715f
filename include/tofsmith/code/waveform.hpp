// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
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

/// One period of a modulation or demodulation function. Binary waveforms are kept as switching
/// times, which no grid can round; all others as N samples, each held over its cell [n, n + 1)/N.
class Waveform {
 public:
  /// `level` inside the intervals, 0 elsewhere.
  /// @throws std::invalid_argument unless intervals are sorted, disjoint and within the period,
  ///         and level is finite and > 0
  static Waveform binary(std::vector<OnInterval> on, double level = 1.0);
  /// @throws std::invalid_argument if empty or not finite
  static Waveform sampled(Eigen::VectorXd samples);
  /// Never on (level 0) or always on.
  static Waveform constant(double level);
  /// Reads samples as switching times: on where above `threshold` (a fraction of the maximum).
  static Waveform binary_from_samples(const Eigen::VectorXd& samples, double level,
                                      double threshold = 0.5);

  bool is_binary() const { return samples_.size() == 0; }
  /// Switching times; empty for a sampled waveform.
  const std::vector<OnInterval>& on_intervals() const { return on_; }
  /// Value while on, of a binary waveform.
  double level() const { return level_; }
  /// Samples (N); empty for a binary waveform.
  const Eigen::VectorXd& samples() const { return samples_; }

  double mean() const;
  double minimum() const;
  double peak() const;
  /// Share of the period in which the waveform is above half its peak; exact for binary ones.
  double duty() const;
  /// Number of jumps in one period.
  int edges() const;

  /// Means over N cells of the period: what a generator with N samples plays. Keeps the mean.
  Eigen::VectorXd cell_averages(int samples) const;
  /// Fourier coefficient of the continuous waveform: integral of x(t) exp(-2 pi i n t) over the
  /// unit period.
  Eigen::VectorXcd harmonics(int highest) const;
  StepFunction steps() const;

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
};

/// A single pulse [0, duty) that emits unit mean power: level 1/duty.
Waveform rectangular_pulse(double duty, double begin = 0.0);

/// `count` equal pulses per period, together on for `duty` of it, of unit mean power.
Waveform pulse_train(int count, double duty);

/// On for half the period, from `begin` [periods], `frequency` times per period.
Waveform square_wave(int frequency, double begin);

}  // namespace tofsmith
