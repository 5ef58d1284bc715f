// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/code/code_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "code/shared/on_intervals.hpp"
#include "core/shared/periodic.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {
constexpr double pi = std::numbers::pi;

/// Splits intervals at the end of the period, sorted within [0, 1].
std::vector<OnInterval> unrolled(const std::vector<OnInterval>& on) {
  std::vector<OnInterval> pieces;
  for (const OnInterval& interval : on) {
    if (interval.fall > 1.0) {
      pieces.push_back({0.0, interval.fall - 1.0});
      pieces.push_back({interval.rise, 1.0});
    } else {
      pieces.push_back(interval);
    }
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const OnInterval& a, const OnInterval& b) { return a.rise < b.rise; });
  return pieces;
}

/// Real and imaginary parts, which the compiler vectorizes better than complex numbers.
struct TurnSums {
  Eigen::ArrayXd real, imaginary;
};

/// Adds sign exp(-2 pi i n t) to sum n. Each block is its first factor times the first block.
void add_turns(double t, double sign, TurnSums& sums) {
  constexpr Eigen::Index block = 64;
  const auto turn = [&](Eigen::Index n) {
    return std::polar(1.0, -2 * pi * wrap(static_cast<double>(n) * t, 1.0));
  };
  const Eigen::Index count = sums.real.size();
  std::array<double, block> real, imaginary;  // of the first block
  for (Eigen::Index n = 0; n < std::min(block, count); ++n) {
    const std::complex<double> first = turn(n);
    real[static_cast<std::size_t>(n)] = first.real();
    imaginary[static_cast<std::size_t>(n)] = first.imag();
  }
  for (Eigen::Index first = 0; first < count; first += block) {
    const std::size_t size = static_cast<std::size_t>(std::min(block, count - first));
    const std::complex<double> factor = sign * turn(first);
    double* const real_sum = sums.real.data() + first;
    double* const imaginary_sum = sums.imaginary.data() + first;
    for (std::size_t n = 0; n < size; ++n) {
      real_sum[n] += factor.real() * real[n] - factor.imag() * imaginary[n];
      imaginary_sum[n] += factor.real() * imaginary[n] + factor.imag() * real[n];
    }
  }
}

/// Sum of cosines at t = (j + offset) / points, j = 0, ..., points - 1.
Eigen::VectorXd values_of(const Eigen::VectorXcd& coefficients, int points, double offset) {
  // Harmonics above points / 2 alias to lower ones, which is exact here.
  Eigen::VectorXcd folded = Eigen::VectorXcd::Zero(points);
  folded[0] = coefficients[0];
  for (Eigen::Index n = 1; n < coefficients.size(); ++n) {
    const std::complex<double> c =
        coefficients[n] *
        std::polar(1.0, 2 * pi * wrap(static_cast<double>(n) * offset / points, 1.0));
    folded[n % points] += c;
    folded[(points - n % points) % points] += std::conj(c);
  }
  const PeriodicTransform transform(points);
  const Eigen::VectorXcd spectrum = static_cast<double>(points) * folded.head(points / 2 + 1);
  Eigen::VectorXd values;
  transform.inverse(spectrum, values);
  return values;
}

/// Points per period: 64 or more per period of the highest harmonic.
int resolving_points(const Eigen::VectorXcd& coefficients) {
  return std::max(256, 64 * static_cast<int>(coefficients.size() - 1));
}

double on_time(const std::vector<OnInterval>& on) {
  double sum = 0.0;
  for (const OnInterval& interval : on) sum += interval.fall - interval.rise;
  return sum;
}
}  // namespace

Waveform Waveform::binary(std::vector<OnInterval> on, double level) {
  require(std::isfinite(level) && level > 0.0, "level", level, "must be finite and > 0");
  for (std::size_t i = 0; i < on.size(); ++i) {
    const std::string name = fmt::format("on interval {}", i);
    const std::string value = fmt::format("[{}, {})", on[i].rise, on[i].fall);
    const bool inside = on[i].rise >= 0.0 && on[i].rise < 1.0 && on[i].fall > on[i].rise &&
                        on[i].fall <= on[i].rise + 1.0;
    require(inside, name, value, "must satisfy 0 <= rise < 1 and rise < fall <= rise + 1");
    const bool last = i + 1 == on.size();
    const double next_rise = last ? on[0].rise + 1.0 : on[i + 1].rise;
    require(on[i].fall <= next_rise, name, value,
            fmt::format("switching times must be sorted: the next rise is at {}", next_rise));
  }
  Waveform waveform;
  waveform.on_ = std::move(on);
  waveform.level_ = level;
  return waveform;
}

Waveform Waveform::sampled(Eigen::VectorXd samples) {
  require(samples.size() > 0, "number of samples", samples.size(), "must be >= 1");
  for (Eigen::Index n = 0; n < samples.size(); ++n)
    require(std::isfinite(samples[n]), fmt::format("sample {}", n), samples[n], "must be finite");
  Waveform waveform;
  waveform.samples_ = std::move(samples);
  return waveform;
}

Waveform Waveform::cosines(Eigen::VectorXcd coefficients) {
  constexpr Eigen::Index max_harmonics = 1 << 16;
  require(coefficients.size() >= 1 && coefficients.size() <= max_harmonics + 1,
          "number of coefficients", coefficients.size(), "must be in [1, 65537]");
  for (Eigen::Index n = 0; n < coefficients.size(); ++n)
    require(std::isfinite(coefficients[n].real()) && std::isfinite(coefficients[n].imag()),
            fmt::format("coefficient {}", n), "NaN or infinite", "must be finite");
  require(coefficients[0].imag() == 0.0, "coefficient 0", coefficients[0].imag(),
          "must be real, because it is the mean");
  Waveform waveform;
  waveform.coefficients_ = std::move(coefficients);
  return waveform;
}

Waveform Waveform::cosine(int frequency, double mean, double amplitude, double phase_rad) {
  require(frequency >= 1, "frequency", frequency, "must be >= 1");
  Eigen::VectorXcd coefficients = Eigen::VectorXcd::Zero(frequency + 1);
  coefficients[0] = mean;
  coefficients[frequency] = std::polar(0.5 * amplitude, -phase_rad);
  return cosines(std::move(coefficients));
}

Waveform Waveform::constant(double level) {
  return level == 0.0 ? binary({}, 1.0) : binary({{0.0, 1.0}}, level);
}

Waveform Waveform::binary_from_samples(const Eigen::VectorXd& samples, double level,
                                       double threshold) {
  const Eigen::Index size = samples.size();
  require(size > 0, "number of samples", size, "must be >= 1");
  const double limit = threshold * samples.maxCoeff();
  const auto on = [&](Eigen::Index n) { return samples[n % size] > limit; };
  std::vector<OnInterval> intervals;
  for (Eigen::Index n = 0; n < size; ++n) {
    if (!on(n) || on(n + size - 1)) continue;
    Eigen::Index end = n + 1;
    while (on(end)) ++end;
    intervals.push_back({static_cast<double>(n) / static_cast<double>(size),
                         static_cast<double>(end) / static_cast<double>(size)});
  }
  if (intervals.empty()) return on(0) ? constant(level) : binary({}, level);
  return binary(std::move(intervals), level);
}

double Waveform::mean() const {
  if (is_binary()) return level_ * on_time(on_);
  return is_sampled() ? samples_.mean() : coefficients_[0].real();
}

double Waveform::minimum() const {
  if (is_sampled()) return samples_.minCoeff();
  if (!is_binary()) return -scaled(0.0, -1.0).peak();
  return on_time(on_) >= 1.0 ? level_ : 0.0;
}

double Waveform::peak() const {
  if (is_sampled()) return samples_.maxCoeff();
  if (is_binary()) return on_.empty() ? 0.0 : level_;
  const Eigen::VectorXcd varying = coefficients_.tail(coefficients_.size() - 1);
  if ((varying.array() != 0.0).count() <= 1) return mean() + 2.0 * varying.cwiseAbs().sum();
  return values_of(coefficients_, resolving_points(coefficients_), 0.0).maxCoeff();
}

double Waveform::duty() const {
  if (is_binary()) return on_time(on_);
  const Eigen::VectorXd values =
      is_sampled() ? samples_ : values_of(coefficients_, resolving_points(coefficients_), 0.5);
  const double half = 0.5 * values.maxCoeff();
  return static_cast<double>((values.array() > half).count()) / static_cast<double>(values.size());
}

int Waveform::edges() const {
  if (!is_binary() && !is_sampled()) return 0;
  const StepFunction function = steps();
  int count = 0;
  for (std::size_t i = 0; i < function.values.size(); ++i) {
    const std::size_t before = i == 0 ? function.values.size() - 1 : i - 1;
    if (function.values[i] != function.values[before]) ++count;
  }
  return count;
}

Eigen::VectorXd Waveform::cell_averages(int samples) const {
  require(samples >= 1, "samples", samples, "must be >= 1");
  if (samples_.size() == samples) return samples_;
  if (coefficients_.size() > 0) {
    // An average over a cell multiplies harmonic n by sin(x) / x with x = pi n / samples.
    Eigen::VectorXcd averaged = coefficients_;
    for (Eigen::Index n = 1; n < averaged.size(); ++n) {
      const double x = pi * static_cast<double>(n) / samples;
      averaged[n] *= std::sin(pi * wrap(static_cast<double>(n) / samples, 2.0)) / x;
    }
    return values_of(averaged, samples, 0.5);
  }
  const StepFunction function = steps();
  Eigen::VectorXd cells = Eigen::VectorXd::Zero(samples);
  const double count = samples;
  for (std::size_t i = 0; i < function.values.size(); ++i) {
    if (function.values[i] == 0.0) continue;
    const bool last = i + 1 == function.values.size();
    const double begin = function.breakpoints[i] * count;
    const double end = (last ? function.breakpoints[0] + 1.0 : function.breakpoints[i + 1]) * count;
    for (double cell = std::floor(begin); cell < end; cell += 1.0) {
      const double share = std::min(end, cell + 1.0) - std::max(begin, cell);
      const int index = static_cast<int>(wrap(cell, count));
      if (share > 1e-12) cells[index] += function.values[i] * share;
    }
  }
  return cells;
}

int Waveform::repetitions() const {
  constexpr int highest = 1024;
  constexpr double negligible = 1e-6;
  const Eigen::VectorXd amplitude = harmonics(highest).tail(highest).cwiseAbs();
  int divisor = 0;
  const double least = negligible * amplitude.maxCoeff();
  for (int n = 1; n <= highest; ++n)
    if (amplitude[n - 1] > least) divisor = std::gcd(divisor, n);
  return std::max(1, divisor);
}

Eigen::VectorXcd Waveform::harmonics(int highest) const {
  Eigen::VectorXcd result = Eigen::VectorXcd::Zero(highest + 1);
  result[0] = mean();
  if (is_binary()) {
    TurnSums turns{Eigen::ArrayXd::Zero(highest + 1), Eigen::ArrayXd::Zero(highest + 1)};
    for (const OnInterval& interval : on_) {
      add_turns(interval.rise, 1.0, turns);
      add_turns(interval.fall, -1.0, turns);
    }
    for (int n = 1; n <= highest; ++n)
      result[n] = level_ / (2 * pi * n) * std::complex<double>(turns.imaginary[n], -turns.real[n]);
    return result;
  }
  if (!is_sampled()) {
    const Eigen::Index count = std::min(result.size(), coefficients_.size());
    result.head(count) = coefficients_.head(count);
    return result;
  }
  const int size = static_cast<int>(samples_.size());
  Eigen::VectorXcd spectrum;
  PeriodicTransform(size).forward(samples_, spectrum);
  // Constant within a cell: sin(x) / x exp(-i x) with x = pi n / size.
  Eigen::VectorXcd held(size);
  for (int k = 0; k < size; ++k) {
    const std::complex<double> dft = k <= size / 2 ? spectrum[k] : std::conj(spectrum[size - k]);
    const double x = pi * k / size;
    held[k] = dft * std::sin(x) * std::polar(1.0, -x) / pi;
  }
  for (int n = 1; n <= highest; ++n) result[n] = held[n % size] / static_cast<double>(n);
  return result;
}

StepFunction Waveform::steps() const {
  StepFunction function;
  if (!is_binary()) {
    const Eigen::VectorXd values =
        is_sampled() ? samples_ : cell_averages(resolving_points(coefficients_));
    const double count = static_cast<double>(values.size());
    for (Eigen::Index n = 0; n < values.size(); ++n) {
      function.breakpoints.push_back(static_cast<double>(n) / count);
      function.values.push_back(values[n]);
    }
    return function;
  }
  const auto add = [&](double position, double value) {
    if (!function.breakpoints.empty() && function.breakpoints.back() == position)
      function.values.back() = value;
    else
      function.breakpoints.push_back(position), function.values.push_back(value);
  };
  add(0.0, 0.0);
  for (const OnInterval& piece : unrolled(on_)) {
    add(piece.rise, level_);
    if (piece.fall < 1.0) add(piece.fall, 0.0);
  }
  return function;
}

Waveform Waveform::scaled(double a, double b) const {
  require(!is_binary(), "waveform", "binary", "must be sampled or a sum of cosines");
  if (is_sampled()) return sampled(a + b * samples_.array());
  Eigen::VectorXcd coefficients = b * coefficients_;
  coefficients[0] += a;
  return cosines(std::move(coefficients));
}

Eigen::VectorXd Waveform::values_at_middles(int points) const {
  require(points >= 1, "points", points, "must be >= 1");
  require(!is_binary(), "waveform", "binary", "must be sampled or a sum of cosines");
  if (!is_sampled()) return values_of(coefficients_, points, 0.5);
  constexpr double rounding = 1e-9;  // for centres on the border of two samples
  Eigen::VectorXd values(points);
  for (int j = 0; j < points; ++j) {
    const double middle = (j + 0.5) / points * static_cast<double>(samples_.size());
    values[j] = samples_[static_cast<Eigen::Index>(middle + rounding)];
  }
  return values;
}

Waveform Waveform::delayed(double periods) const {
  if (is_binary()) {
    std::vector<OnInterval> moved = on_;
    for (OnInterval& interval : moved) {
      const double width = interval.fall - interval.rise;
      interval.rise = wrap(interval.rise + periods, 1.0);
      interval.fall = interval.rise + width;
    }
    return binary(within_period(std::move(moved)), level_);
  }
  if (!is_sampled()) {
    Eigen::VectorXcd moved = coefficients_;
    for (Eigen::Index n = 1; n < moved.size(); ++n)
      moved[n] *= std::polar(1.0, -2 * pi * wrap(static_cast<double>(n) * periods, 1.0));
    return cosines(std::move(moved));
  }
  const double shift = periods * static_cast<double>(samples_.size());
  require(std::abs(shift - std::round(shift)) < 1e-6, "delay", periods,
          "must be a whole number of samples for a sampled waveform");
  return sampled(circular_shift(samples_, static_cast<int>(std::lround(shift))));
}

Waveform Waveform::complement() const {
  require(minimum() >= -1e-12 && peak() <= 1.0 + 1e-12, "peak", peak(),
          "must be in [0, 1] for a complement");
  if (!is_binary()) return scaled(1.0, -1.0);
  if (on_.empty()) return constant(1.0);
  require(level_ == 1.0, "level", level_, "must be 1 for the complement of a binary waveform");
  std::vector<OnInterval> off;
  for (std::size_t i = 0; i < on_.size(); ++i) {
    const bool last = i + 1 == on_.size();
    const double next_rise = last ? on_[0].rise + 1.0 : on_[i + 1].rise;
    if (next_rise <= on_[i].fall) continue;  // touching intervals leave no gap
    const double rise = wrap(on_[i].fall, 1.0);
    off.push_back({rise, rise + (next_rise - on_[i].fall)});
  }
  off = within_period(std::move(off));
  return off.empty() ? constant(0.0) : binary(std::move(off), 1.0);
}

bool operator==(const Waveform& a, const Waveform& b) {
  return a.on_ == b.on_ && a.level_ == b.level_ && a.samples_.size() == b.samples_.size() &&
         a.samples_ == b.samples_ && a.coefficients_.size() == b.coefficients_.size() &&
         a.coefficients_ == b.coefficients_;
}

Waveform rectangular_pulse(double duty, double begin) {
  require(duty > 0.0 && duty <= 1.0, "duty", duty, "must be in (0, 1]");
  const double rise = wrap(begin, 1.0);
  return Waveform::binary({{rise, rise + duty}}, 1.0 / duty);
}

Waveform pulse_train(int count, double duty) {
  require(count >= 1, "number of pulses", count, "must be >= 1");
  require(duty > 0.0 && duty <= 1.0, "duty", duty, "must be in (0, 1]");
  std::vector<OnInterval> on;
  for (int i = 0; i < count; ++i) {
    const double rise = static_cast<double>(i) / count;
    on.push_back({rise, std::min(rise + duty / count, static_cast<double>(i + 1) / count)});
  }
  return Waveform::binary(std::move(on), 1.0 / duty);
}

Waveform square_wave(int frequency, double begin) {
  require(frequency >= 1, "frequency", frequency, "must be >= 1");
  std::vector<OnInterval> on;
  for (int i = 0; i < frequency; ++i) {
    const double rise = wrap(begin + static_cast<double>(i) / frequency, 1.0);
    on.push_back({rise, rise + 0.5 / frequency});
  }
  return Waveform::binary(within_period(std::move(on)));
}

}  // namespace tofsmith
