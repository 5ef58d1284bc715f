// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/shared/periodic.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/decode/decoding_table.hpp"

namespace tofsmith {

/// Waveforms constant within N cells of a grid.
struct SampledCode {
  Eigen::MatrixXd modulation;    ///< (N, E)
  Eigen::MatrixXd demodulation;  ///< (N, E x taps)

  int samples() const { return static_cast<int>(modulation.rows()); }
};

/// Returns true if a decoder must estimate ambient light: not for differences of buckets at duty
/// 1/2, unless their sensitivities differ by more than unknown_ambient_gain() ignores.
bool sees_ambient(const Camera& camera, int exposures);

/// Camera on a grid: correlation functions of waveforms, and gradients w.r.t. the waveforms.
/// Includes band limits, contrast, mismatch and readout of taps.
class SampledCamera {
 public:
  /// A table and the spectra of its waveforms.
  struct Measured {
    MeasurementTable table;
    std::vector<Eigen::VectorXcd> modulation, demodulation;
    std::vector<Eigen::VectorXcd> square;  ///< of squared weights, if needed
    Eigen::MatrixXd weight;                ///< of a mixer (N, E)
  };

  /// A mixer is two buckets (in_buckets()) whose difference is its weight. If weights need not be
  /// binary, its shot noise depends on their square.
  /// @param samples  N of the grid
  SampledCamera(const Camera& camera, int samples, int exposures);

  int samples() const { return transform_.samples(); }
  int measurements() const { return static_cast<int>(combination_.rows()); }
  /// Integration time of every measurement [s] (R).
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }
  /// Variance without light [e^2] (R): read noise, quantization, dark current.
  const Eigen::VectorXd& constant_variance_e2() const { return constant_variance_e2_; }
  /// Electrons of dark current (R).
  const Eigen::VectorXd& dark_electrons() const { return dark_electrons_; }
  /// True if buckets are subtracted, so that shot noise comes from their sum.
  bool subtracts() const { return difference_; }
  bool ambient_unknown() const { return ambient_unknown_; }

  /// Gain of harmonic n in [0, N/2] through both arms, for waveforms constant within cells.
  std::complex<double> transfer(int harmonic) const {
    return transfer_[harmonic] * static_cast<double>(samples());
  }

  Measured measure(const SampledCode& code) const;
  /// Without the table, which pull_back() does not need. Not for mixers.
  Measured transformed(const SampledCode& code) const;

  /// Converts a gradient w.r.t. the table to one w.r.t. the waveforms.
  SampledCode pull_back(const Measured& measured, const MeasurementTable& gradient) const;

 private:
  SampledCamera(const Camera& camera, int samples, int exposures, bool squares);
  void measure_squares(const SampledCode& code, Measured& measured) const;

  PeriodicTransform transform_;
  int exposures_, taps_;
  bool difference_, ambient_unknown_;
  bool squares_;                 // shot noise depends on squared weights
  Eigen::VectorXcd transfer_;    // G / N
  Eigen::MatrixXd combination_;  // (R, all taps): contrast, mismatch, readout
  Eigen::MatrixXd shot_combination_;
  Eigen::VectorXd exposure_s_, constant_variance_e2_, dark_electrons_;
};

/// Returns a zero table of the same shape.
MeasurementTable zeros_like(const MeasurementTable& table);

}  // namespace tofsmith
