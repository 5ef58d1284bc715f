// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tofsmith {

/// Modulations that are looked at side by side.
inline constexpr int scan_lanes = 32;

/// Tables of a block of modulations. A row holds one value of every modulation of the block; the
/// values of a word at depths s, s + 1, .. chips are `chips` + 1 rows one after another.
struct ScanAssignment {
  std::uint32_t row[4];  ///< first row of each tap
};

/// For three taps of equal duty: which modulations make the direction of the measurements turn
/// the same way between all neighbouring depths, and once around in all. Integers, exact.
/// @param counts  rows of chips in which light falls on an open tap
/// @param turning one bit per modulation, for each assignment
void find_turning(const std::int16_t* counts, std::span<const ScanAssignment> assignments,
                  int chips, std::uint32_t* turning);

/// Entries of a Fisher matrix, in the order zz, zs, ss, za, sa, aa: a row of `find_informed` holds
/// the first of all modulations, then the second, ..
inline constexpr int fisher_entries = 6;

/// Fisher matrices at several operating points, each with the largest weights it has on a chip, and
/// how much a code may need.
struct InformationRows {
  std::vector<const float*> point;  ///< first row of every operating point
  /// Largest mean variance, as a geometric mean over the points [chips^2]; infinite: any.
  double limit = 0.0;
};

/// Which modulations may do better than the limit. On a chip with Fisher matrix F at its begin the
/// depth variance, signal and ambient light unknown, has a mean of at least
///   (m0 + m1 + m2 / 3) / det F,
///   m0 = ss aa - sa^2, m1 = zs aa - za sa, m2 = zz aa - za^2,
/// and at least 1 / zz. Rounding is allowed for: no code within the limit is left out.
void find_informed(const InformationRows& information, std::span<const ScanAssignment> assignments,
                   int chips, int taps, std::uint32_t* informed);

/// The same for pairs: the matrices of one exposure (points x chips x entries) added to those of a
/// block of others, whose rows of a point are `chips` one after another, block by block.
/// @param informed  one bit per other, for each block
void find_informed_pairs(const InformationRows& others, std::span<const float> first, int chips,
                         std::size_t blocks, std::uint32_t* informed);

}  // namespace tofsmith
