// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace tofsmith {

/// f(x) = x^T h x / 2 - g^T x of up to three unknowns, h positive semidefinite.
struct Quadratic {
  using Vector = std::array<double, 3>;
  std::array<Vector, 3> h{};
  Vector g{};

  double at(const Vector& x) const;
};

/// The least point of a quadratic with x >= 0 in every component.
struct BoundedMinimum {
  Quadratic::Vector x{};
  double value = 0.0;  ///< f(x) <= f(0) = 0
};

/// Tries all sets of components that are not 0: exact, and nothing to converge.
/// @param unknowns  the first so many components take part, the others stay 0
BoundedMinimum minimize_bounded(const Quadratic& quadratic, int unknowns);

/// What the others leave of h_ii once they are eliminated: the inverse of [h^-1]_ii. 0 if nothing
/// but rounding is left; others that are themselves nothing but rounding are left out.
double left_of(const Quadratic& quadratic, int i);

}  // namespace tofsmith
