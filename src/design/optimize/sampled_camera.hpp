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

/// Waveforms of a code, held over the N cells of a grid.
struct SampledCode {
  Eigen::MatrixXd modulation;    ///< (N, E)
  Eigen::MatrixXd demodulation;  ///< (N, E x taps)

  int samples() const { return static_cast<int>(modulation.rows()); }
};

/// Whether a decoder has to reckon with ambient light: not where buckets that are open half the
/// time are subtracted, unless they differ in sensitivity by more than unknown_ambient_gain()
/// ignores.
bool sees_ambient(const Camera& camera, int exposures);

/// A camera on a grid: from waveforms to correlation functions and back with gradients. Band limit
/// of both arms, contrast, mismatch and the readout of taps are in it.
class SampledCamera {
 public:
  /// A table, with the spectra of the waveforms it is of.
  struct Measured {
    MeasurementTable table;
    std::vector<Eigen::VectorXcd> modulation, demodulation;
    std::vector<Eigen::VectorXcd> square;  ///< of the weights of a mixer, where they count
    Eigen::MatrixXd weight;                ///< those (N, E)
  };

  /// A mixer is taken as two buckets (in_buckets()), whose difference is its weight. Its shot noise
  /// is by the square of that, where weights need not switch.
  /// @param samples  N of the grid
  SampledCamera(const Camera& camera, int samples, int exposures);

  int samples() const { return transform_.samples(); }
  int measurements() const { return static_cast<int>(combination_.rows()); }
  /// Integration time of every measurement [s] (R).
  const Eigen::VectorXd& exposure_s() const { return exposure_s_; }
  /// Variance without any light [e^2] (R): read noise, quantization and dark current.
  const Eigen::VectorXd& constant_variance_e2() const { return constant_variance_e2_; }
  /// Electrons of dark current in every measurement (R).
  const Eigen::VectorXd& dark_electrons() const { return dark_electrons_; }
  /// Whether buckets are subtracted: their shot noise is not that of the difference.
  bool subtracts() const { return difference_; }
  /// sees_ambient() of the camera.
  bool ambient_unknown() const { return ambient_unknown_; }

  /// What the arms leave of harmonic n of waveforms held over the grid's cells, n = 0 .. N/2.
  std::complex<double> transfer(int harmonic) const {
    return transfer_[harmonic] * static_cast<double>(samples());
  }

  Measured measure(const SampledCode& code) const;
  /// The same without the table, which pull_back() does not look at. Not of mixers.
  Measured transformed(const SampledCode& code) const;

  /// Gradient by the waveforms of a function whose gradient by the table is given.
  SampledCode pull_back(const Measured& measured, const MeasurementTable& gradient) const;

 private:
  SampledCamera(const Camera& camera, int samples, int exposures, bool squares);
  void measure_squares(const SampledCode& code, Measured& measured) const;

  PeriodicTransform transform_;
  int exposures_, taps_;
  bool difference_, ambient_unknown_;
  bool squares_;                 // of weights make the shot noise
  Eigen::VectorXcd transfer_;    // G / N
  Eigen::MatrixXd combination_;  // (R, tap values): contrast, mismatch, then readout
  Eigen::MatrixXd shot_combination_;
  Eigen::VectorXd exposure_s_, constant_variance_e2_, dark_electrons_;
};

/// A table of zeros, with what the other has: gradients by tables are summed up in them.
MeasurementTable zeros_like(const MeasurementTable& table);

}  // namespace tofsmith
