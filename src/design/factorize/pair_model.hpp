// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/shared/periodic.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

/// Model of both arms for sampled waveforms, and the residual to a target. Samples are constant
/// within their cells. Correlation functions are compared at the N bins, where the grid model is
/// exact:
///   chi[k] = D[k] conj(M[k]) G[k] / N,  G[k] = sum_j H(k + j N) sinc^2((k + j N) / N).
class PairModel {
 public:
  PairModel(const CorrelationTarget& target, const Camera& camera);

  const Camera& camera() const { return camera_; }
  int samples() const { return transform_.samples(); }
  double peak_factor() const { return peak_factor_; }
  bool binary_modulation() const { return binary_modulation_; }
  bool binary_demodulation() const { return binary_demodulation_; }
  /// Returns the shortest run, on or off, that a binary arm supports [periods].
  double shortest_run() const { return shortest_run_; }
  const CorrelationTarget& target() const { return target_; }
  /// Returns the target at the bins, and the time-reversed target (for the modulation step).
  const Eigen::VectorXd& target_samples() const { return target_.samples; }
  const Eigen::VectorXd& reversed_target_samples() const { return reversed_target_; }
  /// Returns the impulse responses of both arms at the harmonics [0, highest].
  Eigen::VectorXcd transfer(int highest) const { return camera_.transfer(highest); }

  /// Returns the half spectrum (unscaled) of the samples of a waveform.
  Eigen::VectorXcd spectrum(const Eigen::VectorXd& samples) const;

  /// Returns the first column of the circulant matrix that maps demodulation samples to the
  /// correlation function for a fixed modulation.
  Eigen::VectorXd demodulation_kernel(const Eigen::VectorXd& modulation) const;
  /// Returns the same for modulation samples and the time-reversed correlation function.
  Eigen::VectorXd modulation_kernel(const Eigen::VectorXd& demodulation) const;

  /// Returns the RMS residual over the bins, from half spectra.
  double residual_rms(const Eigen::VectorXcd& modulation,
                      const Eigen::VectorXcd& demodulation) const;
  /// Returns the RMS residual over the bins, from samples.
  double residual_rms(const Eigen::VectorXd& modulation, const Eigen::VectorXd& demodulation) const;
  /// Returns the RMS residual over depth for any waveforms. Switching times are exact, the target
  /// is linear between bins, and the difference is sampled at 8 points per bin. If the camera has
  /// generators, their actual waveforms are used; infinite if the actual modulation is zero.
  double residual_rms(const WaveformPair& pair) const;

 private:
  /// Returns the actual waveforms of the generators.
  WaveformPair actual(const WaveformPair& pair) const;

  CorrelationTarget target_;
  Camera camera_;
  double peak_factor_;
  double shortest_run_;
  bool binary_modulation_, binary_demodulation_;
  PeriodicTransform transform_;
  Eigen::VectorXd reversed_target_;
  Eigen::VectorXcd target_spectrum_;
  Eigen::VectorXcd grid_transfer_;  // G / N
};

}  // namespace tofsmith
