// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tofsmith/code/families.hpp"

namespace tofsmith {

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

}  // namespace tofsmith
