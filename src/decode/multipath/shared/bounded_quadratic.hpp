// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace tofsmith {

/// f(x) = x^T h x / 2 - g^T x of up to three unknowns, with h positive semidefinite.
struct Quadratic {
  using Vector = std::array<double, 3>;
  std::array<Vector, 3> h{};
  Vector g{};

  double at(const Vector& x) const;
};

/// Minimum subject to x >= 0.
struct BoundedMinimum {
  Quadratic::Vector x{};
  double value = 0.0;  ///< f(x) <= f(0) = 0
};

/// Returns the exact minimum by trying all sets of nonzero components.
/// @param unknowns  number of components that may be nonzero, from the first
BoundedMinimum minimize_bounded(const Quadratic& quadratic, int unknowns);

/// Returns h_ii after elimination of the other components, 1 / [h^-1]_ii; 0 if only rounding errors
/// remain. Ignores other components that are rounding errors.
double left_of(const Quadratic& quadratic, int i);

}  // namespace tofsmith
