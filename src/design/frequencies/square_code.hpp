// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// Exposures at one modulation frequency.
struct SquareTone {
  int frequency = 1;   ///< multiple of the fundamental
  int phases = 2;      ///< number of exposures
  double share = 1.0;  ///< of the total integration time
};

/// A code of square waves: gates that are open for half of the period, light of one duty.
struct SquareCode {
  double duty = 0.5;
  std::vector<SquareTone> tones;  ///< the highest frequency first

  int exposures() const;
  /// Number of repetitions per period of the fundamental frequency.
  int repetitions() const;
  /// "square-15x2-10x2": frequencies and their number of phases.
  std::string name() const;
};

/// Returns the phases of the exposures of one frequency in steps of 1 / phase_steps periods: a
/// quadrature pair for two exposures, otherwise equal spacing, rounded to the steps.
std::vector<int> phases_in_steps(int phases, int phase_steps);

/// Power of the light while it is on, divided by the average power.
double square_level(double duty, double peak_factor);

/// Returns the code for the taps, peak and samples of a camera with light.square.
CodeSet to_code_set(const SquareCode& code, const Camera& camera);

}  // namespace tofsmith
