// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/multipath/shared/bounded_quadratic.hpp"

#include <cmath>

namespace tofsmith {

namespace {

/// Smaller relative pivots are rounding errors.
constexpr double no_pivot = 1e-13;

/// Solves h x = g for the components in `set`. Returns false if h is singular on them or x is not
/// >= 0.
bool solve_within(const Quadratic& q, unsigned set, Quadratic::Vector& x) {
  std::array<int, 3> index{};
  int size = 0;
  for (int i = 0; i < 3; ++i)
    if (set >> i & 1u) index[static_cast<std::size_t>(size++)] = i;

  // h = L L^T, L y = g, L^T x = y
  double lower[3][3] = {}, y[3] = {};
  const auto h = [&](int a, int b) {
    return q.h[static_cast<std::size_t>(index[static_cast<std::size_t>(a)])]
              [static_cast<std::size_t>(index[static_cast<std::size_t>(b)])];
  };
  for (int a = 0; a < size; ++a) {
    for (int b = 0; b <= a; ++b) {
      double left = h(a, b);
      for (int c = 0; c < b; ++c) left -= lower[a][c] * lower[b][c];
      if (b < a) {
        lower[a][b] = left / lower[b][b];
        continue;
      }
      if (!(left > no_pivot * h(a, a))) return false;
      lower[a][a] = std::sqrt(left);
    }
    double left = q.g[static_cast<std::size_t>(index[static_cast<std::size_t>(a)])];
    for (int c = 0; c < a; ++c) left -= lower[a][c] * y[c];
    y[a] = left / lower[a][a];
  }
  x = {};
  for (int a = size - 1; a >= 0; --a) {
    for (int c = a + 1; c < size; ++c) y[a] -= lower[c][a] * y[c];
    y[a] /= lower[a][a];
    if (!(y[a] >= 0.0)) return false;
    x[static_cast<std::size_t>(index[static_cast<std::size_t>(a)])] = y[a];
  }
  return true;
}

}  // namespace

double Quadratic::at(const Vector& x) const {
  double value = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    value -= g[i] * x[i];
    for (std::size_t j = 0; j < 3; ++j) value += 0.5 * x[i] * h[i][j] * x[j];
  }
  return value;
}

BoundedMinimum minimize_bounded(const Quadratic& quadratic, int unknowns) {
  const unsigned all = (1u << unknowns) - 1;
  BoundedMinimum best;
  Quadratic::Vector x;
  for (unsigned set = all; set > 0; --set) {
    if (!solve_within(quadratic, set, x)) continue;
    const double value = quadratic.at(x);
    if (value < best.value) best = {x, value};
    if (set == all) break;  // the unconstrained minimum is feasible
  }
  return best;
}

double left_of(const Quadratic& quadratic, int i) {
  const auto& h = quadratic.h;
  const auto at = static_cast<std::size_t>(i), j = (at + 1) % 3, k = (at + 2) % 3;
  double own = h[at][at], cross = h[at][k], other = h[k][k];
  if (h[j][j] > 0.0) {
    own -= h[at][j] * h[at][j] / h[j][j];
    cross -= h[at][j] * h[k][j] / h[j][j];
    other -= h[k][j] * h[k][j] / h[j][j];
  }
  if (other > no_pivot * h[k][k]) own -= cross * cross / other;
  return own > no_pivot * h[at][at] ? own : 0.0;
}

}  // namespace tofsmith
