// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/search/exact_projection.hpp"

#include <algorithm>
#include <cmath>

namespace tofsmith {

void ExactProjection::project(const double* raw, PlaneVector& vector) const {
  double size = 0.0;   // sum of |y'|
  double along = 0.0;  // ambient light
  std::fill_n(vector.unit.begin(), rank(), 0.0);
  for (int k = 0; k < measurements(); ++k) {
    const double y = electrons(raw[k], k);
    size += std::abs(y);
    along += ambient_[k] * y;
    for (int j = 0; j < rank(); ++j) vector.unit[static_cast<std::size_t>(j)] += basis_(k, j) * y;
  }
  double length2 = 0.0;
  for (int j = 0; j < rank(); ++j) {
    const double q = vector.unit[static_cast<std::size_t>(j)];
    length2 += q * q;
  }
  const double length = std::sqrt(length2);
  const bool is_seen = length > nothing_left * size;  // false for NaN
  vector.length = is_seen ? length : 0.0 * size;
  double residual2 = 0.0;
  for (int k = 0; k < measurements(); ++k) {
    const double left = electrons(raw[k], k) - along * ambient_[k];
    residual2 += left * left;
  }
  vector.residual = is_seen ? std::max(1.0, std::sqrt(residual2) / length) : 1.0;
  for (int j = 0; j < rank(); ++j) {
    double& unit = vector.unit[static_cast<std::size_t>(j)];
    unit = is_seen && std::isfinite(length) ? unit / length : 0.0;
  }
}

}  // namespace tofsmith
