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
  double other_albedo = 0.5;  ///< of every second field, [0, 1]
  double period_m = 0.1;  ///< width of a field or of the image [m], > 0; on a sphere measured along
                          ///< its equator
  /// Albedo, linear, in [0, 1]; repeats in both directions, with rows opposite to the second
  /// coordinate. For meshes with texture coordinates it covers [0, 1] x [0, 1], regardless of
  /// period_m.
  Image<float> image;

  /// Albedo at surface coordinates [m]; stripes alternate along the first coordinate.
  double at(double first_m, double second_m) const;
  /// Albedo of the nearest pixel of the image at texture coordinates, u to the right, v up.
  double image_at(double u, double v) const;

  /// @throws std::invalid_argument
  void validate() const;
};

/// Triangles with shared vertices, in units of the mesh.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
  /// (u, v) of every vertex over the texture's image, u to the right and v up; may be empty.
  std::vector<Eigen::Vector2d> texture_coordinates;

  /// @throws std::invalid_argument for no triangles, an index out of range, a vertex that is not
  ///         finite, or texture coordinates that are not one per vertex, with index and value
  void validate() const;
};

/// A mesh placed in the world.
struct Mesh {
  TriangleMesh triangles;
  double scale_m = 1.0;  ///< metres per unit of the mesh, > 0
  Eigen::Isometry3d mesh_to_world = Eigen::Isometry3d::Identity();  ///< applied after scaling
  /// Without texture coordinates, patterns follow the mesh's own x and y axes [m].
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
  Eigen::Vector3d normal;   ///< unit vector, towards either side
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
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();        ///< edge lengths, each > 0
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< columns are the axes of the box
  Texture texture;
};

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 1.0;  ///< > 0
  Texture texture;
};

/// All points within a radius of a line segment, e.g. a finger, a limb or a pole with round ends.
struct Capsule {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::UnitY();  ///< may equal start: a sphere
  double radius_m = 0.1;                           ///< > 0
  Texture texture;  ///< first coordinate around the axis, second along it
};

using Shape = std::variant<Plane, Box, Sphere, Capsule, Mesh>;

/// Return the nearest intersection in front of the ray's origin, in closed form.
std::optional<Hit> intersect(const Plane& plane, const Ray& ray);
std::optional<Hit> intersect(const Box& box, const Ray& ray);
std::optional<Hit> intersect(const Sphere& sphere, const Ray& ray);
std::optional<Hit> intersect(const Capsule& capsule, const Ray& ray);
/// Tests every triangle; a reference for RayCaster, which is faster.
std::optional<Hit> intersect(const Mesh& mesh, const Ray& ray);

/// @throws std::invalid_argument
void validate(const Shape& shape);

}  // namespace tofsmith
