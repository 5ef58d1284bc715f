// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

struct SquareTone {
  int frequency = 1;  ///< multiple of the fundamental
  int phases = 2;
  double share = 1.0;  ///< of the total integration time
};

/// Square waves: gates that are open for half of the period, light of one duty.
struct SquareCode {
  double duty = 0.5;
  std::vector<SquareTone> tones;

  int exposures() const;
  /// Repetitions per fundamental period.
  int repetitions() const;
  /// "square-15x2-10x2": frequencies and numbers of phases.
  std::string name() const;
};

/// Returns phases in steps of 1 / phase_steps periods: a quadrature pair for two exposures,
/// otherwise equal spacing, rounded to the steps.
std::vector<int> phases_in_steps(int phases, int phase_steps);

/// Power while the light is on, divided by the average power.
double square_level(double duty, double peak_factor);

CodeSet to_code_set(const SquareCode& code, const Camera& camera);

}  // namespace tofsmith
