// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/optimize/sampled_camera.hpp"

namespace tofsmith {

/// Which waveforms a design may choose from.
struct WaveformSpace {
  int cells = 120;  ///< switching times lie on this many cells per period
  int repeat = 1;   ///< samples per cell
  int exposures = 0;
  int taps = 1;
  /// Charge may also go nowhere. One tap always has that choice; two buckets never do.
  bool drain = false;
  double peak_factor = 15.0;
  bool equal_duties = false;  ///< the two buckets of an exposure are each open half the time

  int samples() const { return cells * repeat; }
  /// Where charge can go at a time: a tap, or the drain, which comes last.
  int classes() const { return taps + (drain ? 1 : 0); }
  /// Columns of free parameters per exposure: with two classes one says all.
  int columns() const { return classes() == 2 ? 1 : classes(); }

  friend bool operator==(const WaveformSpace&, const WaveformSpace&) = default;
};

/// How steeply waveforms follow their parameters: at large values they only switch.
struct Sharpness {
  double modulation = 1.0;
  double demodulation = 1.0;
};

/// Free numbers behind the waveforms of a code; every choice of them is playable.
///   modulation    m = p s(k (phi - lambda)), s the logistic function, lambda such that mean m = 1:
///                 the light may so use less than its peak
///   demodulation  one of two classes: s(k theta); more: softmax(k theta) over the classes
struct WaveformParameters {
  Eigen::MatrixXd modulation;    ///< phi (cells, E)
  Eigen::MatrixXd demodulation;  ///< theta (cells, E x columns)
};

/// The waveforms at these parameters.
SampledCode render(const WaveformSpace& space, const WaveformParameters& parameters,
                   const Sharpness& sharpness);

/// Gradient by the parameters of a function whose gradient by the waveforms is given.
/// @param code  render(space, parameters, sharpness)
WaveformParameters pull_back(const WaveformSpace& space, const SampledCode& code,
                             const Sharpness& sharpness, const SampledCode& gradient);

/// Parameters whose waveforms come close to the code's: +-scale where it is on or off.
WaveformParameters parameters_near(const WaveformSpace& space, const SampledCode& code,
                                   double scale);

}  // namespace tofsmith
