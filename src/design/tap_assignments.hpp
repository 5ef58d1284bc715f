// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "tofsmith/design/chip_code.hpp"

namespace tofsmith {

/// Most taps that assignments are enumerated for.
inline constexpr int most_assigned_taps = 4;

/// What each chip of a period is given to: one of the taps, or none.
struct TapAssignment {
  std::array<ChipWord, most_assigned_taps> taps{};
  bool is_achiral = false;  ///< played backwards it is itself, but for a delay and the taps' order
};

/// Which assignments are listed.
struct AssignmentRules {
  int chips = 9;
  int taps = 3;
  bool equal_duty = true;    ///< every tap is open for as many chips
  bool drain = true;         ///< chips may be given to no tap
  bool up_to_mirror = true;  ///< of two that are each other played backwards, one
};

/// One assignment of every kind that delays, the order of taps (and playing backwards) make of each
/// other; no tap is always shut. In an order that depends on the rules alone.
std::vector<TapAssignment> tap_assignments(const AssignmentRules& rules);

/// How many there are before symmetry is used.
double raw_tap_assignments(const AssignmentRules& rules);

/// The least of all delays of every word (2^n).
std::vector<ChipWord> necklace_table(int chips);
/// Modulations up to delays: on at least once and off at least once, in ascending order.
std::vector<ChipWord> modulation_necklaces(int chips);

}  // namespace tofsmith
