// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "simulate/ziv_zakai.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tofsmith {
namespace {

constexpr double pi = std::numbers::pi;

/// Shifts h in (0, 1/2).
struct Shifts {
  Eigen::ArrayXd middle, width;
};

/// Fine where delays are hard to distinguish, and finer than the highest harmonic.
Shifts shifts_for(double slope, Eigen::Index highest) {
  constexpr Eigen::Index near_cells = 48;
  constexpr double distinct_at = 8.0;  // in standard deviations
  const double near = std::min(0.5, distinct_at / slope);
  const auto far_cells = static_cast<Eigen::Index>(
      near < 0.5
          ? std::ceil((0.5 - near) * static_cast<double>(std::max<Eigen::Index>(128, 8 * highest)))
          : 0.0);
  Shifts shifts{Eigen::ArrayXd(near_cells + far_cells), Eigen::ArrayXd(near_cells + far_cells)};
  for (Eigen::Index j = 0; j < shifts.middle.size(); ++j) {
    const bool is_near = j < near_cells;
    const double width =
        is_near ? near / near_cells : (0.5 - near) / static_cast<double>(far_cells);
    shifts.middle[j] = is_near ? (static_cast<double>(j) + 0.5) * width
                               : near + (static_cast<double>(j - near_cells) + 0.5) * width;
    shifts.width[j] = width;
  }
  return shifts;
}

/// Q(root(x) / 2), the probability that a normal deviation exceeds half the distance.
double confusion(double squared_distance) {
  return 0.5 * std::erfc(std::sqrt(squared_distance / 8.0));
}

double confusion_slope(double squared_distance) {
  constexpr double least = 1e-12;  // avoids the singularity at 0
  const double x = std::max(squared_distance, least);
  return -std::exp(-x / 8.0) / (4.0 * std::sqrt(2.0 * pi * x));
}

/// Integral over 0 < h < 1/2 for squared distances h^2 information.
double confused_by_information(double information) {
  const double root = std::sqrt(information), end = root / 4.0;  // of half the distance
  const double density_fall = -std::expm1(-0.5 * end * end) / std::sqrt(2.0 * pi);
  return 2.0 / root * (end * confusion(4.0 * end * end) + density_fall);
}

Eigen::Index last_that_matters(const Eigen::VectorXd& power) {
  constexpr Eigen::Index most = 96;
  constexpr double share = 1e-4;  // relative to the largest
  Eigen::Index kept = power.size();
  while (kept > 0 && (kept > most || power[kept - 1] <= share * power.maxCoeff())) --kept;
  return kept;
}

}  // namespace

double ziv_zakai_mae(const Eigen::VectorXd& power, double information) {
  // Harmonics beyond `kept` share one column, an upper limit for each of them.
  const Eigen::Index kept = last_that_matters(power), more = power.size() - kept;
  const Eigen::ArrayXd harmonic = Eigen::ArrayXd::LinSpaced(kept, 1.0, static_cast<double>(kept));
  double slope_power = power.size() > 0 && kept == 0 ? 0.0 : information;
  if (kept > 0)
    slope_power = std::min(
        information, (4.0 * pi * pi * harmonic.square() * power.head(kept).array()).maxCoeff());
  if (slope_power <= 0.0) return 0.25;
  if (slope_power == std::numeric_limits<double>::infinity()) return 0.0;
  if (kept == 0) return confused_by_information(information);

  const Shifts shifts = shifts_for(std::sqrt(slope_power), kept);
  const Eigen::ArrayXd largest = shifts.middle.square() * information;
  Eigen::MatrixXd distance(shifts.middle.size(), kept + (more > 0 ? 1 : 0));
  for (Eigen::Index n = 0; n < kept; ++n)
    distance.col(n) = 4.0 * power[n] * (pi * harmonic[n] * shifts.middle).sin().square();
  if (more > 0) distance.col(kept).setConstant(4.0 * power.tail(more).maxCoeff());

  // Exponentiated gradient descent. The sum is convex in the shares, so its tangent plane at any of
  // them is a lower bound everywhere.
  constexpr int max_steps = 200;
  constexpr double tolerance = 2e-3;
  const Eigen::Index columns = distance.cols();
  Eigen::VectorXd shares = Eigen::VectorXd::Constant(columns, 1.0 / static_cast<double>(columns));
  double bound = 0.0;
  for (int step = 0; step < max_steps; ++step) {
    const Eigen::ArrayXd mean = (distance * shares).array();
    const double sum = (shifts.width * mean.min(largest).unaryExpr(&confusion)).sum();
    const Eigen::ArrayXd slope =
        (mean < largest).select(shifts.width * mean.unaryExpr(&confusion_slope), 0.0);
    const Eigen::VectorXd gradient = distance.transpose() * slope.matrix();
    bound = std::max(bound, sum + gradient.minCoeff() - gradient.dot(shares));
    if (sum - bound <= tolerance * sum) break;
    const double steepest = gradient.cwiseAbs().maxCoeff();
    if (steepest == 0.0) break;
    const double rate = 1.0 / (steepest * (1.0 + 0.005 * step));
    shares = shares.array() * (-(gradient.array() - gradient.minCoeff()) * rate).exp();
    shares /= shares.sum();
  }
  return bound;
}

}  // namespace tofsmith
