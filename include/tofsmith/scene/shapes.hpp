// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

namespace tofsmith {

/// How a surface reflects: one albedo, or two that alternate.
struct Texture {
  enum class Pattern { uniform, checker, stripes };
  Pattern pattern = Pattern::uniform;
  double albedo = 0.5;        ///< [0, 1]
  double other_albedo = 0.5;  ///< of every second field, [0, 1]
  double period_m = 0.1;      ///< width of a field [m], > 0; on a sphere measured along its equator

  /// Albedo at surface coordinates [m]; stripes alternate along the first.
  double at(double first_m, double second_m) const;
};

/// A half-line from a camera.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit length
};

/// Where a ray meets a surface.
struct Hit {
  double distance_m = 0.0;  ///< from the ray's origin, > 0
  Eigen::Vector3d normal;   ///< unit length, towards either side
  double albedo = 0.0;
};

/// An unbounded plane.
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< any length but 0
  Texture texture;
};

/// A box, turned about its centre.
struct Box {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();        ///< edge lengths, each > 0
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< columns are the box's axes
  Texture texture;
};

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 1.0;  ///< > 0
  Texture texture;
};

using Shape = std::variant<Plane, Box, Sphere>;

/// Nearest intersection in front of the ray's origin, in closed form.
std::optional<Hit> intersect(const Plane& plane, const Ray& ray);
std::optional<Hit> intersect(const Box& box, const Ray& ray);
std::optional<Hit> intersect(const Sphere& sphere, const Ray& ray);

/// @throws std::invalid_argument naming field, value and rule
void validate(const Shape& shape);

}  // namespace tofsmith
