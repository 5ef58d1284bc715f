// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// What a family must respect of the camera it is built for.
struct FamilyOptions {
  int samples = 240;         ///< N
  double peak_factor = 1e9;  ///< p = P_max / P_ave >= 1; a huge value gives the ideal code
  bool exact_grid = true;    ///< refuse N that would round the code's switching times
  void validate() const;
};

/// Sinusoid modulation and demodulation, demodulation shifted in `phase_steps` equal steps.
/// Modulation is 1 + min(1, p - 1) cos, so that it stays within the peak.
CodeSet sinusoid_code(int phase_steps, const FamilyOptions& options);

/// One frequency of a multi-frequency code and how many phases of it are measured.
struct FrequencySteps {
  int frequency = 1;  ///< multiple of the fundamental
  int steps = 3;      ///< phase steps; 2 means a quadrature pair (0 and 90 degrees)
};

/// Multi-frequency sinusoids: for each entry a sinusoid with its phase steps.
/// The paper's K = 5 code is {{1, 3}, {7, 2}}.
CodeSet multi_frequency_code(const std::vector<FrequencySteps>& frequencies,
                             const FamilyOptions& options);

}  // namespace tofsmith
