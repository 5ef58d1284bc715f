// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/code/families.hpp"

namespace tofsmith {

/// Square demodulation in equal steps; modulation has duty max(1/2, 1/p).
CodeSet square_code(int phase_steps, const FamilyOptions& options);

/// Pulses with phase steps at the fundamental, and a quadrature pair at `high_frequency` (>= 2)
/// times the fundamental with pulses of duty max(1/p, 1/4); demodulation is square. Not in the
/// paper.
/// @param low_steps  3, with duty max(1/p, 1/6); or 2, a quadrature pair with duty max(1/p, 1/4),
///                   which with two buckets measures four phases in two exposures
CodeSet pulsed_multi_frequency_code(int low_steps, int high_frequency,
                                    const FamilyOptions& options);

/// One light for all five exposures: a burst of pulses at `high_frequency` (>= 2) times the
/// fundamental in about the first half of the period. Demodulation: square waves, three steps at
/// the fundamental and a quadrature pair at the high frequency.
/// @see Bao et al., "Learnable Burst-Encodable Time-of-Flight Imaging for High-Fidelity
///   Long-Distance Depth Sensing", arXiv 2505.22025 (2025), whose bursts are learned
CodeSet burst_code(int high_frequency, const FamilyOptions& options);

/// Gray-coded binary demodulation of 2^bits depth cells with a pulse of one cell (longer if the
/// peak factor requires it). All-zeros and all-ones have no contrast: a one-tap sensor cannot
/// distinguish these two cells from each other or from no return.
CodeSet gray_code(int bits, const FamilyOptions& options);

}  // namespace tofsmith
