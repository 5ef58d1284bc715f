// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tofsmith/design/chip_search.hpp"

namespace tofsmith {

inline constexpr int scan_lanes = 32;

/// Table rows of an assignment. A row holds one value per modulation of a block; a word has
/// consecutive rows for the depths s, ..., s + chips.
struct ScanAssignment {
  std::uint32_t row[4];  ///< first row of each tap
};

/// Finds, for three taps of equal duty, the modulations whose direction of the measurements turns
/// in one sense between adjacent depths, exactly once in total. Exact (integers).
/// @param counts  rows of the number of chips with light on an open tap
/// @param turning  one bit per modulation, for each assignment
void find_turning(const std::int16_t* counts, std::span<const ScanAssignment> assignments,
                  int chips, std::uint32_t* turning);

/// Entries zz, zs, ss, za, sa, aa of a Fisher matrix. A row contains one entry for all modulations.
inline constexpr int fisher_entries = 6;

/// Fisher matrices with the largest weights on each chip, and the limit of the score.
struct InformationRows {
  std::vector<const float*> point;  ///< first row per operating point
  /// Limit of the geometric mean of gamma [chips^2]; infinite: none.
  double limit = 0.0;
  ChipMetric metric = ChipMetric::unknown_light;
};

/// Finds the modulations that may be better than the limit. With Fisher matrix F at the start of a
/// chip, the mean depth variance on the chip is at least 1 / zz and, with unknown signal and
/// ambient light, at least
///   (m0 + m1 + m2 / 3) / det F,
///   m0 = ss aa - sa^2, m1 = zs aa - za sa, m2 = zz aa - za^2.
/// Tolerances for rounding ensure that no code within the limit is excluded.
void find_informed(const InformationRows& information, std::span<const ScanAssignment> assignments,
                   int chips, int taps, std::uint32_t* informed);

/// As find_informed() for pairs: adds the matrices of one exposure (points x chips x entries) to
/// the matrices of each other exposure.
/// @param informed  one bit per other exposure, for each block
void find_informed_pairs(const InformationRows& others, std::span<const float> first, int chips,
                         std::size_t blocks, std::uint32_t* informed);

}  // namespace tofsmith
