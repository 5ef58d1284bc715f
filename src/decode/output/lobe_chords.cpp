// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "decode/output/lobe_chords.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tofsmith {

namespace {

constexpr double negligible = 40.0;
const double sqrt_two_pi = std::sqrt(2 * std::numbers::pi);

/// Mills ratio of the normal distribution, to 10 %.
double mills_ratio(double x) { return 2.0 / (x + std::sqrt(x * x + 8.0 / std::numbers::pi)); }

}  // namespace

void ChordMass::add(double c, double factor, bool is_inside) {
  if (!(c > 0.0)) return;
  const double square = 0.5 * c * c;
  if (square > peak_) {
    const double by = std::exp(peak_ - square);
    inside_ *= by;
    outside_ *= by;
    peak_ = square;
  }
  (is_inside ? inside_ : outside_) += factor * sqrt_two_pi / c * std::exp(square - peak_);
}

void ChordMass::add_chord(double from, double to, double cosine, bool is_inside) {
  const double sine2 = 1.0 - cosine * cosine;
  if (!(sine2 > 1e-14)) return add(std::max(from, to), 1.0, is_inside);
  // c(theta) = from cos(theta) + across sin(theta)
  const double sine = std::sqrt(sine2), across = (to - from * cosine) / sine;
  const bool is_within = across >= 0.0 && across * cosine <= from * sine;
  const double rho = std::hypot(from, across);
  const double largest = is_within ? rho : std::max(from, to);
  if (!(largest > 0.0) || 0.5 * largest * largest < peak_ - negligible) return;
  const double angle = std::atan2(sine, cosine), best = std::atan2(across, from);
  const auto past_end = [&](double c, double by) {
    add(c, std::min(1.0, mills_ratio(rho * std::sin(std::min(by, 1.5))) / (rho * angle)),
        is_inside);
  };
  if (!is_within) return from > to ? past_end(from, -best) : past_end(to, best - angle);
  const double both = std::erf(rho * best * std::numbers::sqrt2 / 2) +
                      std::erf(rho * (angle - best) * std::numbers::sqrt2 / 2);
  add(rho, 0.5 * both * sqrt_two_pi / (rho * angle), is_inside);
}

void ChordMass::add_ends(double from, double to, bool is_inside) {
  add(from, 0.5, is_inside);
  add(to, 0.5, is_inside);
}

double ChordMass::share_inside() const {
  const double whole = inside_ + outside_;
  return whole > 0.0 ? inside_ / whole : 1.0;
}

}  // namespace tofsmith
