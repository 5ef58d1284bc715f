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

/// Waveforms of a code, constant within each of N cells of a grid.
struct SampledCode {
  Eigen::MatrixXd modulation;    ///< (N, E)
  Eigen::MatrixXd demodulation;  ///< (N, E x taps)

  int samples() const { return static_cast<int>(modulation.rows()); }
};

/// Returns true if a decoder must estimate ambient light. Not for differences of buckets that are
/// open half the time, unless their sensitivities differ by more than unknown_ambient_gain()
/// ignores.
bool sees_ambient(const Camera& camera, int exposures);

/// Camera on a grid: computes correlation functions of waveforms, and gradients with respect to the
/// waveforms. Includes the band limit of both arms, contrast, mismatch and the readout of taps.
class SampledCamera {
 public:
  /// A table, with the spectra of its waveforms.
  struct Measured {
    MeasurementTable table;
    std::vector<Eigen::VectorXcd> modulation, demodulation;
    std::vector<Eigen::VectorXcd> square;  ///< of the squared weights of a mixer, if needed
    Eigen::MatrixXd weight;                ///< weights of a mixer (N, E)
  };

  /// A mixer is modelled as two buckets (in_buckets()) whose difference is its weight. If weights
  /// need not be binary, its shot noise depends on the squared weight.
  /// @param samples  N of the grid
  SampledCamera(const Camera& camera, int samples, int exposures);

  int samples() const { return transform_.samples(); }
  int measurements() const { return static_cast<int>(combination_.rows()); }
  /// Returns the integration time of every measurement [s] (R).
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }
  /// Returns the variance without light [e^2] (R): read noise, quantization and dark current.
  const Eigen::VectorXd& constant_variance_e2() const { return constant_variance_e2_; }
  /// Returns the electrons of dark current in every measurement (R).
  const Eigen::VectorXd& dark_electrons() const { return dark_electrons_; }
  /// Returns true if buckets are subtracted, so that shot noise comes from their sum.
  bool subtracts() const { return difference_; }
  /// Returns sees_ambient() of the camera.
  bool ambient_unknown() const { return ambient_unknown_; }

  /// Returns the gain of harmonic n in [0, N/2] through both arms, for waveforms constant within
  /// cells.
  std::complex<double> transfer(int harmonic) const {
    return transfer_[harmonic] * static_cast<double>(samples());
  }

  Measured measure(const SampledCode& code) const;
  /// As measure(), but without the table, which pull_back() does not need. Not for mixers.
  Measured transformed(const SampledCode& code) const;

  /// Converts a gradient with respect to the table to one with respect to the waveforms.
  SampledCode pull_back(const Measured& measured, const MeasurementTable& gradient) const;

 private:
  SampledCamera(const Camera& camera, int samples, int exposures, bool squares);
  void measure_squares(const SampledCode& code, Measured& measured) const;

  PeriodicTransform transform_;
  int exposures_, taps_;
  bool difference_, ambient_unknown_;
  bool squares_;                 // true if shot noise depends on squared weights
  Eigen::VectorXcd transfer_;    // G / N
  Eigen::MatrixXd combination_;  // (R, taps of all exposures): contrast, mismatch, then readout
  Eigen::MatrixXd shot_combination_;
  Eigen::VectorXd exposure_s_, constant_variance_e2_, dark_electrons_;
};

/// Returns a zero table with the shape of another one, for accumulating gradients.
MeasurementTable zeros_like(const MeasurementTable& table);

}  // namespace tofsmith
