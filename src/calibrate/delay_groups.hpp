// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace tofsmith {

/// Frames of a sweep that share a place in the period.
struct DelayGroups {
  std::vector<double> place;        ///< of each group in [0, 1), rising (G)
  std::vector<int> group_of_frame;  ///< (F)
  std::vector<int> repeats;         ///< frames of each group (G)
  double span_periods = 0.0;        ///< of the delays as given
  double first_periods = 0.0;       ///< the least delay
  bool equal_steps = false;         ///< the places are equally spaced round the period
  bool from_zero = false;           ///< and one of them is 0, so that they are those of N = G rows

  int count() const { return static_cast<int>(place.size()); }
  bool has_repeats() const { return place.size() < group_of_frame.size(); }
};

/// Delays that differ by less than 2 % of the usual step, whole periods apart, are one.
DelayGroups delay_groups(const std::vector<double>& delay_periods);

/// @throws std::invalid_argument saying which part of the period is missing
void require_whole_period(const DelayGroups& groups);

}  // namespace tofsmith
