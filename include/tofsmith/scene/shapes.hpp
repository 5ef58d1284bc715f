// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "tofsmith/core/image.hpp"

namespace tofsmith {

/// Albedo of a surface: uniform, two alternating values, or an image.
struct Texture {
  enum class Pattern { uniform, checker, stripes, image };
  Pattern pattern = Pattern::uniform;
  double albedo = 0.5;        ///< [0, 1]; scales the values of an image
  double other_albedo = 0.5;  ///< of every second field
  double period_m = 0.1;      ///< of a field or of the image, > 0; on a sphere along its equator
  /// Linear albedo, repeated in both directions, with rows opposite to the second coordinate. On
  /// texture coordinates of meshes it covers [0, 1] x [0, 1], regardless of period_m.
  Image<float> image;

  /// Albedo at surface coordinates; stripes alternate along the first.
  double at(double first_m, double second_m) const;
  /// Nearest pixel of the image, u to the right, v up.
  double image_at(double u, double v) const;

  /// @throws std::invalid_argument
  void validate() const;
};

/// Triangles with shared vertices, in units of the mesh.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// (u, v) of every vertex, u to the right and v up; may be empty.
  std::vector<Eigen::Vector2d> texture_coordinates;

  /// @throws std::invalid_argument for no triangles, an index out of range, vertices that are not
  ///         finite, or texture coordinates that are not one per vertex
  void validate() const;
};

/// A mesh in the world.
struct Mesh {
  TriangleMesh triangles;
  double scale_m = 1.0;  ///< metres per unit of the mesh, > 0
  Eigen::Isometry3d mesh_to_world = Eigen::Isometry3d::Identity();  ///< applied after scaling
  /// Without texture coordinates, patterns follow the x and y axes of the mesh [m].
  Texture texture;
};

/// A half-line from a camera.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit vector
};

/// Intersection of a ray with a surface.
struct Hit {
  double distance_m = 0.0;  ///< from the origin of the ray, > 0
  Eigen::Vector3d normal;   ///< unit, towards either side
  double albedo = 0.0;
};

/// An unbounded plane.
struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< any length > 0
  Texture texture;
};

/// A box, rotated about its centre.
struct Box {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();        ///< each > 0
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< columns are the axes
  Texture texture;
};

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 1.0;  ///< > 0
  Texture texture;
};

/// All points within a radius of a line segment.
struct Capsule {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::UnitY();  ///< may equal start
  double radius_m = 0.1;                           ///< > 0
  Texture texture;  ///< first coordinate around the axis, second along it
};

using Shape = std::variant<Plane, Box, Sphere, Capsule, Mesh>;

/// Return the nearest intersection in front of the ray's origin.
std::optional<Hit> intersect(const Plane& plane, const Ray& ray);
std::optional<Hit> intersect(const Box& box, const Ray& ray);
std::optional<Hit> intersect(const Sphere& sphere, const Ray& ray);
std::optional<Hit> intersect(const Capsule& capsule, const Ray& ray);
/// Tests every triangle; see RayCaster.
std::optional<Hit> intersect(const Mesh& mesh, const Ray& ray);

/// @throws std::invalid_argument
void validate(const Shape& shape);

}  // namespace tofsmith
