// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/core/lens_distortion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tofsmith/core/error.hpp"

namespace tofsmith {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Distorted position and its derivative.
struct Imaged {
  Vector2d image;
  Matrix2d slope;
};

class OpenCvFormula {
 public:
  /// @param cross  1 in rational-6kt
  explicit OpenCvFormula(const std::vector<double>& given, double cross = 2.0) : cross_(cross) {
    std::copy_n(given.begin(), std::min(given.size(), c_.size()), c_.begin());
  }

  Imaged operator()(const Vector2d& at) const {
    const auto [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4] = c_;
    const double x = at.x(), y = at.y(), q = x * x + y * y;
    const double above = 1 + q * (k1 + q * (k2 + q * k3)),
                 above_dq = k1 + q * (2 * k2 + 3 * q * k3);
    const double below = 1 + q * (k4 + q * (k5 + q * k6)),
                 below_dq = k4 + q * (2 * k5 + 3 * q * k6);
    const double radial = above / below;
    const double dq = (above_dq - radial * below_dq) / below;
    // Thin prism terms depend only on q = r^2.
    const double x_dq = s1 + 2 * q * s2, y_dq = s3 + 2 * q * s4;
    Imaged result;
    result.image = {
        x * radial + cross_ * p1 * x * y + p2 * (q + 2 * x * x) + q * (s1 + q * s2),
        y * radial + p1 * (q + 2 * y * y) + cross_ * p2 * x * y + q * (s3 + q * s4),
    };
    result.slope << radial + 2 * x * (x * dq + x_dq) + cross_ * p1 * y + 6 * p2 * x,
        2 * y * (x * dq + x_dq) + cross_ * p1 * x + 2 * p2 * y,
        2 * x * (y * dq + y_dq) + 2 * p1 * x + cross_ * p2 * y,
        radial + 2 * y * (y * dq + y_dq) + 6 * p1 * y + cross_ * p2 * x;
    return result;
  }

  static Vector2d of_ideal(const Vector2d& ideal) { return ideal; }
  static std::optional<Vector2d> ideal_of(const Vector2d& place) { return place; }

 private:
  std::array<double, 12> c_{};
  double cross_;
};

/// The fisheye polynomial, for positions whose distance from the axis is the angle.
class FisheyeFormula {
 public:
  explicit FisheyeFormula(const std::vector<double>& given) {
    std::copy_n(given.begin(), std::min(given.size(), c_.size()), c_.begin());
  }

  Imaged operator()(const Vector2d& at) const {
    const auto [k1, k2, k3, k4] = c_;
    const double q = at.squaredNorm();
    const double radial = 1 + q * (k1 + q * (k2 + q * (k3 + q * k4)));
    const double dq = k1 + q * (2 * k2 + q * (3 * k3 + 4 * q * k4));
    return {radial * at, radial * Matrix2d::Identity() + 2 * dq * at * at.transpose()};
  }

  static Vector2d of_ideal(const Vector2d& ideal) {
    const double r = ideal.norm();
    return r > 0.0 ? Vector2d(ideal * (std::atan(r) / r)) : ideal;
  }
  static std::optional<Vector2d> ideal_of(const Vector2d& place) {
    const double angle = place.norm();
    if (!(angle < std::numbers::pi / 2)) return std::nullopt;
    return angle > 0.0 ? Vector2d(place * (std::tan(angle) / angle)) : place;
  }

 private:
  std::array<double, 4> c_{};
};

template <typename Use>
auto with_formula(const LensDistortion& distortion, const Use& use) {
  const std::vector<double>& given = distortion.coefficients;
  if (distortion.model == DistortionModel::fisheye) return use(FisheyeFormula(given));
  return use(OpenCvFormula(given, distortion.model == DistortionModel::opencv ? 2.0 : 1.0));
}

/// Newton's method. None if the position would be on another fold: orientation reversed, or the
/// path bends too much.
template <typename Formula>
std::optional<Vector2d> next_place(const Formula& formula, const Vector2d& start,
                                   const Vector2d& target) {
  constexpr int max_steps = 12;
  constexpr double max_bend = 0.1, tolerance = 1e-10;
  Vector2d place = start, straight = start;
  for (int i = 0; i < max_steps; ++i) {
    const Imaged at = formula(place);
    const double area = at.slope(0, 0) * at.slope(1, 1) - at.slope(0, 1) * at.slope(1, 0);
    if (!(area > 0.0)) return std::nullopt;
    const Vector2d miss = target - at.image;
    const Vector2d move{(at.slope(1, 1) * miss.x() - at.slope(0, 1) * miss.y()) / area,
                        (at.slope(0, 0) * miss.y() - at.slope(1, 0) * miss.x()) / area};
    place += move;
    if (!place.allFinite()) return std::nullopt;
    if (i == 0) straight = place;
    if ((place - straight).norm() > max_bend * (straight - start).norm()) return std::nullopt;
    if (move.norm() <= tolerance * (1.0 + place.norm())) return place;
  }
  return std::nullopt;
}

struct Followed {
  Vector2d place;
  double reach;  ///< fraction of the path
};

/// Returns true beyond max_radius.
template <typename Formula>
bool is_beyond(const Formula& formula, const Vector2d& place, std::optional<double> max_radius) {
  if (!max_radius) return false;
  const auto ideal = formula.ideal_of(place);
  return !ideal || ideal->norm() > *max_radius;
}

/// Follows the straight line from the axis to an image, so that the position stays on the first
/// fold.
/// @param first_step  fraction of the line; reduced where the path bends
template <typename Formula>
Followed follow(const Formula& formula, const Vector2d& image, double first_step,
                std::optional<double> max_radius) {
  constexpr double shortest_step = 1e-6;
  Followed way{Vector2d::Zero(), 0.0};
  for (double step = first_step; way.reach < 1.0;) {
    const double next = std::min(1.0, way.reach + step);
    if (const auto place = next_place(formula, way.place, next * image)) {
      way = {*place, next};
      if (is_beyond(formula, *place, max_radius)) break;
      step = std::min(2.0 * step, first_step);
    } else {
      step *= 0.5;
      if (step < shortest_step) break;
    }
  }
  return way;
}

}  // namespace

Vector2d LensDistortion::distort(const Vector2d& ideal) const {
  return with_formula(*this, [&](const auto& formula) -> Vector2d {
    return formula(formula.of_ideal(ideal)).image;
  });
}

std::optional<Vector2d> LensDistortion::undistort(const Vector2d& distorted) const {
  return with_formula(*this, [&](const auto& formula) -> std::optional<Vector2d> {
    const Followed way = follow(formula, distorted, 1.0, max_radius);
    const bool is_seen = way.reach >= 1.0 && !is_beyond(formula, way.place, max_radius);
    return is_seen ? formula.ideal_of(way.place) : std::nullopt;
  });
}

double LensDistortion::reach(const Vector2d& distorted) const {
  constexpr double careful_step = 0.125;
  return with_formula(*this, [&](const auto& formula) {
    const Followed way = follow(formula, distorted, careful_step, max_radius);
    if (is_beyond(formula, way.place, max_radius)) return 1.0;
    if (formula.ideal_of(way.place)) return way.reach;
    // The fisheye's right angle in this direction.
    const Vector2d edge = (0.5 * std::numbers::pi / way.place.norm()) * way.place;
    return std::min(way.reach, formula(edge).image.norm() / distorted.norm());
  });
}

void LensDistortion::validate(std::string_view field) const {
  const std::size_t count = coefficients.size();
  const std::string shown = fmt::format("[{}]", fmt::join(coefficients, ", "));
  if (model == DistortionModel::opencv)
    require(count == 4 || count == 5 || count == 8 || count == 12 || count == 14, field, shown,
            "must be 4, 5, 8, 12 or 14 numbers: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [0 0]]]]");
  else if (model == DistortionModel::fisheye)
    require(count == 4, field, shown, "must be the 4 numbers of a fisheye model: k1 k2 k3 k4");
  else
    require(count == 8, field, shown, "must be 8 numbers: k1 k2 p1 p2 k3 k4 k5 k6");
  require(std::all_of(coefficients.begin(), coefficients.end(),
                      [](double c) { return std::isfinite(c); }),
          field, shown, "must be finite");
  require(count < 14 || (coefficients[12] == 0.0 && coefficients[13] == 0.0), field, shown,
          "must have a tilt of 0 (the last two numbers): tilted sensors are not supported");
}

}  // namespace tofsmith
