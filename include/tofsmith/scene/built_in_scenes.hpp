// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// A uniform motion in world axes: rotation about a centre that moves in a straight line.
struct Motion {
  Eigen::Vector3d velocity_m_per_s = Eigen::Vector3d::Zero();
  /// Axis of rotation by the right-hand rule; its length is the rate [rad/s].
  Eigen::Vector3d turn_rad_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_centre_m = Eigen::Vector3d::Zero();  ///< at time 0

  bool is_still() const { return velocity_m_per_s.isZero(0.0) && turn_rad_per_s.isZero(0.0); }
  /// Maps the position of a point at time 0 to its position at time t: c + v t + R(t) (x - c).
  Eigen::Isometry3d at(double time_s) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule
  void validate(std::string_view field) const;
};

/// Returns a moved shape. Textures of planes, spheres and capsules do not rotate.
Shape moved(const Shape& shape, const Eigen::Isometry3d& motion);

/// A scene and the pose of its camera at time 0.
struct StagedScene {
  std::vector<Shape> shapes;
  PinholeView view;
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();
  Motion camera_motion = {};
  std::vector<Motion> shape_motions = {};  ///< one per shape; empty: all shapes are static

  /// Returns true if nothing moves.
  bool is_still() const;
  bool shapes_are_still() const;
  /// Returns the scene at a given time, without motions.
  /// @throws std::invalid_argument if motions are not finite, or not one per shape
  StagedScene at(double time_s) const;
};

std::vector<std::string> built_in_scene_names();

/// Returns a scene without files. All except `table-top` are seen along z from the origin.
///
/// | name      | shapes, by index                                                             |
/// |-----------|------------------------------------------------------------------------------|
/// | table-top | table, wall, three books, ball                                               |
/// | books     | 0 to 2 books with covers at z = 1.2, 1.4, 1.6 m, the first (leftmost) dark;  |
/// |           | 3 a wall at 3.2 m; 4 the table                                               |
/// | ball      | 0 a volleyball of radius 20 cm, centre at 1 m; 1 a wall at 2.5 m             |
/// | wall      | 0 a wall at 0.5 m that faces the camera                                      |
/// | corner    | 0 and 1 two walls that meet at a right angle, 3 m ahead, of albedo 0.7       |
/// | room      | as corner, and 2 a floor 1 m below the camera, of albedo 0.4                 |
/// | hand      | capsules: an open right hand, 19 cm long, and its forearm, about 0.5 m away  |
/// | moving-   | the hand, 8 cm further left, moving right at 1 m/s, in front of a wall at    |
/// |  hand     | 1 m (the last shape)                                                         |
///
/// @throws std::invalid_argument for an unknown name
/// @see Gutierrez-Barragan et al., CVPR 2019, Figs. 7, 10 and 11; other sizes are assumed
StagedScene built_in_scene(std::string_view name, int width = 320, int height = 240);

/// Places a mesh, whose y axis points up, facing a camera that looks along z.
/// @param scale_m   metres per unit of the mesh, > 0
/// @param centre_m  of its bounding box
/// @throws std::invalid_argument if the mesh is a single point
Mesh upright_mesh(TriangleMesh triangles, double scale_m, const Eigen::Vector3d& centre_m);

/// Returns a scene of one mesh that fills 80 % of the image's width or height. The camera looks
/// along the mesh's -z axis with y up; the view is 60 degrees wide.
/// @param scale_m  metres per unit of the mesh, > 0
/// @throws std::invalid_argument if the mesh or a number is invalid
StagedScene framed_mesh(TriangleMesh triangles, double scale_m, int width, int height);

}  // namespace tofsmith
