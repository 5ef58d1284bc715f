// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/shared/periodic.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith {

/// What the two arms of a camera make of sampled waveforms, and how far that is from a target.
/// Samples are held over their cells; correlation functions are compared at the N bins, where the
/// grid model is exact:
///   chi[k] = D[k] conj(M[k]) G[k] / N,  G[k] = sum_j H(k + j N) sinc^2((k + j N) / N).
class PairModel {
 public:
  PairModel(const CorrelationTarget& target, const Camera& camera);

  const Camera& camera() const { return camera_; }
  int samples() const { return transform_.samples(); }
  double peak_factor() const { return peak_factor_; }
  bool binary_modulation() const { return binary_modulation_; }
  bool binary_demodulation() const { return binary_demodulation_; }
  /// Shortest run, on or off, that an arm which only switches may play [periods].
  double shortest_run() const { return shortest_run_; }
  const CorrelationTarget& target() const { return target_; }
  /// Target at the bins, and the same read backwards (what the modulation step fits).
  const Eigen::VectorXd& target_samples() const { return target_.samples; }
  const Eigen::VectorXd& reversed_target_samples() const { return reversed_target_; }
  /// Impulse responses of both arms at the harmonics 0 .. highest.
  Eigen::VectorXcd transfer(int highest) const { return camera_.transfer(highest); }

  /// Half spectrum (unscaled) of a waveform's samples.
  Eigen::VectorXcd spectrum(const Eigen::VectorXd& samples) const;

  /// First column of the circulant matrix that turns demodulation samples into the correlation
  /// function, modulation fixed.
  Eigen::VectorXd demodulation_kernel(const Eigen::VectorXd& modulation) const;
  /// The same for modulation samples and the reversed correlation function.
  Eigen::VectorXd modulation_kernel(const Eigen::VectorXd& demodulation) const;

  /// rms over the bins of (correlation function - target), from half spectra.
  double residual_rms(const Eigen::VectorXcd& modulation,
                      const Eigen::VectorXcd& demodulation) const;
  /// The same from samples.
  double residual_rms(const Eigen::VectorXd& modulation, const Eigen::VectorXd& demodulation) const;
  /// rms over depth for waveforms of any kind: switching times enter exactly, the target is linear
  /// between bins, and the difference is sampled at 8 points per bin. Of what the camera's
  /// generators make of the pair, where it has any; infinite where that is no light.
  double residual_rms(const WaveformPair& pair) const;

 private:
  /// What the generators play for a pair.
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
