// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "tofsmith/code/waveform.hpp"

namespace tofsmith {

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
class CodeSet {
 public:
  /// @param samples  N, the number of time samples that stand for one period
  /// @throws std::invalid_argument naming the waveform and the rule it breaks
  static CodeSet create(std::string name, int samples, int taps, std::vector<Waveform> modulation,
                        std::vector<Waveform> demodulation);

  const std::string& name() const { return name_; }
  int samples() const { return samples_; }
  int taps() const { return taps_; }
  int exposures() const { return static_cast<int>(modulation_.size()); }
  int measurements() const { return static_cast<int>(demodulation_.size()); }
  int exposure_of(int measurement) const { return measurement / taps_; }

  /// Modulation function of one exposure.
  const Waveform& modulation(int exposure) const {
    return modulation_[static_cast<std::size_t>(exposure)];
  }
  /// Demodulation function of one measurement.
  const Waveform& demodulation(int measurement) const {
    return demodulation_[static_cast<std::size_t>(measurement)];
  }
  /// Modulation that measurement i sees.
  const Waveform& modulation_of(int measurement) const {
    return modulation(exposure_of(measurement));
  }

  /// Largest modulation value of all exposures: the peak factor the code needs.
  double peak() const;
  /// Cell averages of the modulation functions, (N, E).
  Eigen::MatrixXd modulation_samples() const;
  /// Cell averages of the demodulation functions, (N, K).
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

  Provenance provenance;

 private:
  CodeSet() = default;
  std::string name_;
  int samples_ = 0;
  int taps_ = 1;
  std::vector<Waveform> modulation_;
  std::vector<Waveform> demodulation_;
};

}  // namespace tofsmith
