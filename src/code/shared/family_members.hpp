// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tofsmith/code/families.hpp"
#include "tofsmith/core/error.hpp"

namespace tofsmith {

// First rule that a family member violates. If the grid does not divide the samples, the rule
// suggests the nearest usable N.

std::optional<BrokenRule> options_misfit(const FamilyOptions& options);
std::optional<BrokenRule> multi_frequency_misfit(const std::vector<FrequencySteps>& frequencies,
                                                 const FamilyOptions& options);
std::optional<BrokenRule> square_misfit(int phase_steps, const FamilyOptions& options);
std::optional<BrokenRule> pulsed_multi_frequency_misfit(int low_steps, int high_frequency,
                                                        const FamilyOptions& options);
std::optional<BrokenRule> gray_misfit(int bits, const FamilyOptions& options);
std::optional<BrokenRule> hamiltonian_misfit(int measurements, const FamilyOptions& options);

/// Order of exposures and taps: tap t of exposure e measures step e + t steps / taps.
std::vector<int> steps_by_tap(int steps, int taps);

/// Rule that the walk of a Hamiltonian code violates.
std::optional<BrokenRule> walk_misfit(int measurements);

std::string pulsed_multi_frequency_name(int low_steps, int high_frequency);

/// Names of all members that can be built: up to 10 measurements, higher frequencies up to
/// `highest_frequency`; lists of frequencies are the fundamental and one more with 2 to 4 steps
/// each.
std::vector<std::string> family_members(const FamilyOptions& options, int highest_frequency);

/// Returns a closed walk along the edges of the K-cube: consecutive vertices (bit k: code k is on)
/// differ in one bit, no vertex repeats, all-zeros and all-ones are excluded, and every bit is on
/// in half of the vertices. Its length is maximal: 2^K - 2 for odd K and 2^K - 4 for even K. Walks
/// for K = 3, 4, 5 are published.
/// @throws std::invalid_argument unless 3 <= K <= 10
std::vector<std::uint32_t> hamiltonian_walk(int measurements);

/// Edges L of the walk: 6, 12, 30, 60, ...
int hamiltonian_length(int measurements);

/// Demodulation follows the walk, modulation is one pulse of duty max(1/p, 1/L), so that the coding
/// curve runs along the edges of the cube.
/// @see Gupta et al., "What are optimal coding functions for time-of-flight imaging?", ACM Trans.
///      Graph. 37(2), 2018; Gutierrez-Barragan et al., CVPR 2019, Sec. 4
CodeSet hamiltonian_code(int measurements, const FamilyOptions& options);

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
