// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "design/gradients/between_bins.hpp"

#include <algorithm>
#include <array>

#include "design/grid_transfer.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

/// Unused entries are 0.
std::array<double, harmonic_block> in_periods(std::span<const double> depth_bin, int samples) {
  std::array<double, harmonic_block> periods{};
  for (std::size_t p = 0; p < depth_bin.size(); ++p) periods[p] = wrap(depth_bin[p] / samples, 1.0);
  return periods;
}

/// Harmonics n and -n of a real function are combined.
double times(int n) { return n == 0 ? 1.0 : 2.0; }

}  // namespace

BetweenBins::BetweenBins(const Camera& camera, int samples)
    : samples_(samples),
      straight_(!camera.band_limited()),
      transform_(samples),
      shares_(straight_ ? Eigen::VectorXcd() : harmonic_shares(camera, samples)) {}

void BetweenBins::Functions::add(const Functions& others) {
  for (std::size_t i = 0; i < harmonics.real.size(); ++i) {
    harmonics.real[i] += others.harmonics.real[i];
    harmonics.imag[i] += others.harmonics.imag[i];
  }
  chords += others.chords;
}

BetweenBins::Functions BetweenBins::zeros(int functions) const {
  Functions result{{static_cast<int>(shares_.size()), functions}, {}};
  if (straight_) result.chords = Eigen::MatrixXd::Zero(functions, samples_);
  return result;
}

BetweenBins::Functions BetweenBins::of(const Eigen::MatrixXd& table) const {
  Functions result = zeros(static_cast<int>(table.cols()));
  if (straight_) {
    result.chords = table.transpose();
    return result;
  }
  Eigen::VectorXd samples;
  Eigen::VectorXcd spectrum;
  for (int f = 0; f < result.count(); ++f) {
    samples = table.col(f);
    transform_.forward(samples, spectrum);
    for (int n = 0; n < shares_.size(); ++n) {
      const int k = n % samples_;
      const std::complex<double> coefficient =
          k < spectrum.size() ? spectrum[k] : std::conj(spectrum[samples_ - k]);
      const std::complex<double> harmonic = times(n) / samples_ * shares_[n] * coefficient;
      result.harmonics.real[result.harmonics.at(n, f)] = harmonic.real();
      result.harmonics.imag[result.harmonics.at(n, f)] = harmonic.imag();
    }
  }
  return result;
}

BetweenBins::Chord BetweenBins::chord_at(double depth_bin) const {
  const double position = wrap(depth_bin, static_cast<double>(samples_));
  const Eigen::Index bin = std::min<Eigen::Index>(static_cast<int>(position), samples_ - 1);
  return {bin, bin + 1 < samples_ ? bin + 1 : 0, position - static_cast<double>(bin)};
}

void BetweenBins::evaluate(const Functions& functions, std::span<const double> depth_bin,
                           double* values, double* slopes) const {
  if (!straight_) {
    sum_harmonics(functions.harmonics, in_periods(depth_bin, samples_).data(), values, slopes);
    if (slopes)
      for (int i = 0; i < functions.count() * harmonic_block; ++i) slopes[i] /= samples_;
    return;
  }
  for (std::size_t p = 0; p < depth_bin.size(); ++p) {
    const Chord chord = chord_at(depth_bin[p]);
    for (int f = 0; f < functions.count(); ++f) {
      const std::size_t at = static_cast<std::size_t>(f) * harmonic_block + p;
      const double here = functions.chords(f, chord.bin), there = functions.chords(f, chord.next);
      values[at] = (1.0 - chord.fraction) * here + chord.fraction * there;
      if (slopes) slopes[at] = there - here;
    }
  }
}

void BetweenBins::add(std::span<const double> depth_bin, const double* weights,
                      Functions& gradient) const {
  if (!straight_) {
    add_harmonics(in_periods(depth_bin, samples_).data(), weights, gradient.harmonics);
    return;
  }
  for (std::size_t p = 0; p < depth_bin.size(); ++p) {
    const Chord chord = chord_at(depth_bin[p]);
    for (int f = 0; f < gradient.count(); ++f) {
      const double weight = weights[static_cast<std::size_t>(f) * harmonic_block + p];
      gradient.chords(f, chord.bin) += (1.0 - chord.fraction) * weight;
      gradient.chords(f, chord.next) += chord.fraction * weight;
    }
  }
}

Eigen::MatrixXd BetweenBins::fine_table(const Functions& functions, int finer) const {
  const int points = finer * samples_;
  Eigen::MatrixXd fine(points, functions.count());
  if (straight_) {
    for (int j = 0; j < points; ++j) {
      const int bin = j / finer, next = (bin + 1) % samples_;
      const double fraction = static_cast<double>(j % finer) / finer;
      fine.row(j) =
          ((1.0 - fraction) * functions.chords.col(bin) + fraction * functions.chords.col(next))
              .transpose();
    }
    return fine;
  }
  const PeriodicTransform transform(points);
  Eigen::VectorXcd spectrum(transform.coefficients());
  Eigen::VectorXd values;
  for (int f = 0; f < functions.count(); ++f) {
    spectrum.setZero();
    for (int n = 0; n < shares_.size(); ++n) {
      const int k = n % points;
      const std::size_t at = functions.harmonics.at(n, f);
      const std::complex<double> harmonic(functions.harmonics.real[at],
                                          functions.harmonics.imag[at]);
      if (2 * k <= points) spectrum[k] += points / times(n) * harmonic;
      if (2 * k >= points || (k == 0 && n > 0))
        spectrum[(points - k) % points] += points / times(n) * std::conj(harmonic);
    }
    transform.inverse(spectrum, values);
    fine.col(f) = values;
  }
  return fine;
}

BetweenBins::Functions BetweenBins::pull_back_fine(const Eigen::MatrixXd& by_fine,
                                                   int finer) const {
  const int points = finer * samples_;
  Functions gradient = zeros(static_cast<int>(by_fine.cols()));
  if (straight_) {
    for (int j = 0; j < points; ++j) {
      const int bin = j / finer, next = (bin + 1) % samples_;
      const double fraction = static_cast<double>(j % finer) / finer;
      gradient.chords.col(bin) += (1.0 - fraction) * by_fine.row(j).transpose();
      gradient.chords.col(next) += fraction * by_fine.row(j).transpose();
    }
    return gradient;
  }
  const PeriodicTransform transform(points);
  Eigen::VectorXd values;
  Eigen::VectorXcd spectrum;
  for (int f = 0; f < gradient.count(); ++f) {
    values = by_fine.col(f);
    transform.forward(values, spectrum);
    // Adjoint of a cos - b sin: sums of values cos and -values sin.
    for (int n = 0; n < shares_.size(); ++n) {
      const int k = n % points;
      const std::complex<double> sum =
          2 * k <= points ? spectrum[k] : std::conj(spectrum[points - k]);
      gradient.harmonics.real[gradient.harmonics.at(n, f)] = sum.real();
      gradient.harmonics.imag[gradient.harmonics.at(n, f)] = sum.imag();
    }
  }
  return gradient;
}

Eigen::MatrixXd BetweenBins::pull_back(const Functions& gradient) const {
  if (straight_) return gradient.chords.transpose();
  Eigen::MatrixXd by_table(samples_, gradient.count());
  Eigen::VectorXd samples;
  Eigen::VectorXcd spectrum(transform_.coefficients());
  for (int f = 0; f < gradient.count(); ++f) {
    spectrum.setZero();
    for (int n = 0; n < shares_.size(); ++n) {
      const std::size_t at = gradient.harmonics.at(n, f);
      const std::complex<double> by_harmonic(gradient.harmonics.real[at],
                                             gradient.harmonics.imag[at]);
      const std::complex<double> by_coefficient = times(n) * std::conj(shares_[n]) * by_harmonic;
      const int k = n % samples_;
      if (k < spectrum.size())
        spectrum[k] += by_coefficient;
      else
        spectrum[samples_ - k] += std::conj(by_coefficient);
    }
    // The inverse transform adds conjugates, so halve coefficients that have one.
    for (Eigen::Index k = 1; k < spectrum.size(); ++k)
      if (2 * k != samples_) spectrum[k] *= 0.5;
    transform_.inverse(spectrum, samples);
    by_table.col(f) = samples;
  }
  return by_table;
}

}  // namespace tofsmith
