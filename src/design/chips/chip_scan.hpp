// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tofsmith {

/// Number of modulations that are processed in parallel.
inline constexpr int scan_lanes = 32;

/// Row numbers of an assignment in the tables of a block of modulations. A row holds one value for
/// each modulation of the block. The values of a word at depths s, s + 1, ..., s + chips are in
/// `chips` + 1 consecutive rows.
struct ScanAssignment {
  std::uint32_t row[4];  ///< first row of each tap
};

/// Finds, for three taps of equal duty, the modulations for which the direction of the measurements
/// turns in the same sense between all adjacent depths, exactly once in total. Integer arithmetic,
/// exact.
/// @param counts  rows with the number of chips with light on an open tap
/// @param turning  one bit per modulation, for each assignment
void find_turning(const std::int16_t* counts, std::span<const ScanAssignment> assignments,
                  int chips, std::uint32_t* turning);

/// Number of entries of a Fisher matrix, in the order zz, zs, ss, za, sa, aa. A row of
/// find_informed() contains the first entry of all modulations, then the second, and so on.
inline constexpr int fisher_entries = 6;

/// Fisher matrices at several operating points, each with the largest weights on its chip, and the
/// limit of the score.
struct InformationRows {
  std::vector<const float*> point;  ///< first row of each operating point
  /// Limit of the mean depth variance, geometric mean over the points [chips^2]; infinite: none.
  double limit = 0.0;
};

/// Finds the modulations that may be better than the limit. With Fisher matrix F at the start of a
/// chip, the mean depth variance on that chip, with unknown signal and ambient light, is at least
/// 1 / zz and at least
///   (m0 + m1 + m2 / 3) / det F,
///   m0 = ss aa - sa^2, m1 = zs aa - za sa, m2 = zz aa - za^2.
/// Tolerances for rounding ensure that no code within the limit is excluded.
void find_informed(const InformationRows& information, std::span<const ScanAssignment> assignments,
                   int chips, int taps, std::uint32_t* informed);

/// As find_informed() for pairs of exposures: adds the matrices of one exposure (points x chips x
/// entries) to the matrices of each other exposure of several blocks. For each point, the rows of a
/// block are `chips` consecutive rows.
/// @param informed  one bit per other exposure, for each block
void find_informed_pairs(const InformationRows& others, std::span<const float> first, int chips,
                         std::size_t blocks, std::uint32_t* informed);

}  // namespace tofsmith
