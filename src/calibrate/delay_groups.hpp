// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace tofsmith {

struct DelayGroups {
  std::vector<double> place;  ///< in [0, 1), increasing (G)
  std::vector<int> group_of_frame;
  std::vector<int> repeats;  ///< frames (G)
  double span_periods = 0.0;
  double first_periods = 0.0;
  bool equal_steps = false;  ///< positions are equally spaced over the period
  bool from_zero = false;    ///< positions are the rows of a table with N = G

  int count() const { return static_cast<int>(place.size()); }
  bool has_repeats() const { return place.size() < group_of_frame.size(); }
};

/// Groups delays that differ by less than 2 % of the usual step, modulo the period.
DelayGroups delay_groups(const std::vector<double>& delay_periods);

/// @throws std::invalid_argument naming the missing part of the period
void require_whole_period(const DelayGroups& groups);

}  // namespace tofsmith
