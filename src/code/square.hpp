// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/code/families.hpp"

namespace tofsmith {

/// Square demodulation in `phase_steps` equal steps; modulation is on for max(1/2, 1/p).
CodeSet square_code(int phase_steps, const FamilyOptions& options);

/// Steps at the fundamental, modulated by pulses, and a quadrature pair at `high_frequency` (>= 2)
/// times the fundamental with pulses of duty max(1/p, 1/4); demodulation is square throughout. A
/// strong baseline the paper does not consider.
/// @param low_steps  3 with pulses of duty max(1/p, 1/6), or 2, a quadrature pair with duty
///                   max(1/p, 1/4): with two buckets that is four phases in two exposures
CodeSet pulsed_multi_frequency_code(int low_steps, int high_frequency,
                                    const FamilyOptions& options);

/// Gray-coded binary demodulation of 2^bits depth cells, read out with a pulse of one cell (longer
/// where the peak demands it). The all-zeros and all-ones words have no contrast, so a one-tap
/// sensor cannot tell those two cells from each other or from no return.
CodeSet gray_code(int bits, const FamilyOptions& options);

}  // namespace tofsmith
