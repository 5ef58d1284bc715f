// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "tofsmith/scene/mesh.hpp"
#include "tofsmith/scene/texture.hpp"

namespace tofsmith {

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

/// All points within a radius of a line segment: a finger, a limb, a pole with round ends.
struct Capsule {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::UnitY();  ///< may equal start: a sphere
  double radius_m = 0.1;                           ///< > 0
  Texture texture;  ///< first coordinate around the axis, second along it
};

using Shape = std::variant<Plane, Box, Sphere, Capsule, Mesh>;

/// Nearest intersection in front of the ray's origin, in closed form.
std::optional<Hit> intersect(const Plane& plane, const Ray& ray);
std::optional<Hit> intersect(const Box& box, const Ray& ray);
std::optional<Hit> intersect(const Sphere& sphere, const Ray& ray);
std::optional<Hit> intersect(const Capsule& capsule, const Ray& ray);
/// Triangle by triangle: a reference. RayCaster is the fast way.
std::optional<Hit> intersect(const Mesh& mesh, const Ray& ray);

/// @throws std::invalid_argument naming field, value and rule
void validate(const Shape& shape);

}  // namespace tofsmith
