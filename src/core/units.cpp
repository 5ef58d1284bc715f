// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/units.hpp"

#include <cmath>

namespace tofsmith {

double wrap(double position, double period) {
  const double wrapped = position - period * std::floor(position / period);
  return wrapped < period ? wrapped : 0.0;  // rounding can land exactly on the end point
}

double circular_difference(double to, double from, double period) {
  return wrap(to - from + 0.5 * period, period) - 0.5 * period;
}

}  // namespace tofsmith
