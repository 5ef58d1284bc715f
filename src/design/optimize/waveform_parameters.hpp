// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "design/optimize/sampled_camera.hpp"

namespace tofsmith {

/// Set of waveforms of a design.
struct WaveformSpace {
  int cells = 120;  ///< cells per period; switching times are multiples of a cell
  int repeat = 1;   ///< samples per cell
  int exposures = 0;
  int taps = 1;
  /// Charge may also be discarded. Always possible for one tap, never for two buckets.
  bool drain = false;
  double peak_factor = 15.0;
  bool equal_duties = false;  ///< each of the two buckets of an exposure is open half the time

  int samples() const { return cells * repeat; }
  /// Returns the number of destinations of charge: taps, and the drain as the last one.
  int classes() const { return taps + (drain ? 1 : 0); }
  /// Returns the number of parameter columns per exposure; one is sufficient for two classes.
  int columns() const { return classes() == 2 ? 1 : classes(); }

  friend bool operator==(const WaveformSpace&, const WaveformSpace&) = default;
};

/// Steepness of waveforms as a function of their parameters; at large values they are nearly
/// binary.
struct Sharpness {
  double modulation = 1.0;
  double demodulation = 1.0;
};

/// Free parameters of the waveforms of a code; all values are feasible.
///   modulation    m = p s(k (phi - lambda)), s the logistic function, lambda such that mean m = 1;
///                 the light may stay below its peak
///   demodulation  two classes: s(k theta); more: softmax(k theta) over the classes
struct WaveformParameters {
  Eigen::MatrixXd modulation;    ///< phi (cells, E)
  Eigen::MatrixXd demodulation;  ///< theta (cells, E x columns)
};

/// Computes the waveforms for these parameters.
SampledCode render(const WaveformSpace& space, const WaveformParameters& parameters,
                   const Sharpness& sharpness);

/// Converts a gradient with respect to the waveforms to one with respect to the parameters.
/// @param code  render(space, parameters, sharpness)
WaveformParameters pull_back(const WaveformSpace& space, const SampledCode& code,
                             const Sharpness& sharpness, const SampledCode& gradient);

/// Returns parameters whose waveforms approximate the code: +scale where on, -scale where off.
WaveformParameters parameters_near(const WaveformSpace& space, const SampledCode& code,
                                   double scale);

}  // namespace tofsmith
