// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

namespace {

/// Smallest root above `lowest` of (t + b)^2 = discriminant.
std::optional<double> nearest_root(double b, double discriminant, double lowest) {
  if (discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  for (const double t : {-b - root, -b + root})
    if (t > lowest) return t;
  return std::nullopt;
}

}  // namespace

std::optional<Hit> intersect(const Capsule& capsule, const Ray& ray) {
  const Eigen::Vector3d span = capsule.end - capsule.start;
  const double length_m = span.norm();
  const Eigen::Vector3d axis =
      length_m > 0.0 ? Eigen::Vector3d(span / length_m) : Eigen::Vector3d::UnitY();
  std::optional<double> nearest;
  const auto along = [&](double t) {
    return axis.dot(ray.origin + t * ray.direction - capsule.start);
  };
  // Accept a hit only on its part: the side between the ends, a cap beyond.
  const auto try_part = [&](double b, double discriminant, auto&& belongs) {
    double lowest = 0.0;
    while (const auto t = nearest_root(b, discriminant, lowest)) {
      if (belongs(along(*t))) {
        if (!nearest || *t < *nearest) nearest = t;
        return;
      }
      lowest = *t;
    }
  };

  const Eigen::Vector3d offset = ray.origin - capsule.start;
  const Eigen::Vector3d across = ray.direction - axis.dot(ray.direction) * axis;
  const Eigen::Vector3d aside = offset - axis.dot(offset) * axis;
  const double a = across.squaredNorm();
  if (a > 1e-24) {
    const double b = across.dot(aside) / a;
    const double missed_m = (aside - b * across).norm();
    try_part(b, (capsule.radius_m - missed_m) * (capsule.radius_m + missed_m) / a,
             [&](double at) { return at >= 0.0 && at <= length_m; });
  }
  for (const bool far_end : {false, true}) {
    const Eigen::Vector3d from = ray.origin - (far_end ? capsule.end : capsule.start);
    const double b = from.dot(ray.direction);
    const double missed_m = from.cross(ray.direction).norm();
    try_part(b, (capsule.radius_m - missed_m) * (capsule.radius_m + missed_m),
             [&](double at) { return far_end ? at >= length_m : at <= 0.0; });
  }
  if (!nearest) return std::nullopt;

  const Eigen::Vector3d point = ray.origin + *nearest * ray.direction;
  const double at = along(*nearest);
  const Eigen::Vector3d foot = capsule.start + std::clamp(at, 0.0, length_m) * axis;
  const Eigen::Vector3d normal = (point - foot) / capsule.radius_m;
  const Eigen::Vector3d first = axis.unitOrthogonal();
  const double angle_rad = std::atan2(normal.dot(axis.cross(first)), normal.dot(first));
  return Hit{*nearest, normal, capsule.texture.at(capsule.radius_m * angle_rad, at)};
}

}  // namespace tofsmith
