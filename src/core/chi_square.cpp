// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "core/shared/chi_square.hpp"

#include <cmath>
#include <numbers>

namespace tofsmith {

double chi_square_tail(double value, int degrees) {
  // Q_1(x) = erfc(sqrt(x / 2)), Q_2(x) = exp(-x / 2),
  // Q_(d + 2)(x) = Q_d(x) + (x / 2)^(d / 2) exp(-x / 2) / Gamma(d / 2 + 1).
  const double half = 0.5 * value;
  const bool is_odd = degrees % 2 == 1;
  double tail = is_odd ? std::erfc(std::sqrt(half)) : std::exp(-half);
  double term =
      is_odd ? 2.0 * std::sqrt(half / std::numbers::pi) * std::exp(-half) : half * std::exp(-half);
  for (int d = is_odd ? 1 : 2; d < degrees; d += 2) {
    tail += term;
    term *= half / (0.5 * d + 1.0);
  }
  return tail;
}

double chi_square_quantile_of_tail(double rate, int degrees) {
  double low = 0.0, high = degrees;
  while (chi_square_tail(high, degrees) > rate) high *= 2.0;
  for (;;) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) return high;
    (chi_square_tail(middle, degrees) > rate ? low : high) = middle;
  }
}

}  // namespace tofsmith
