// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace tofsmith {

/// Part of the unambiguous range, which may wrap around its end, in fractions of the range.
struct RangePart {
  double begin = 0.0;   ///< in [0, 1)
  double length = 1.0;  ///< 1 or more: the whole range

  bool is_whole() const { return length >= 1.0; }
  bool contains(double position) const {
    const double after = position - begin;
    return after - std::floor(after) <= length;
  }
};

}  // namespace tofsmith
