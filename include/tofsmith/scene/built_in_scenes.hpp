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

/// A uniform motion: a rigid body rotates about a centre that moves in a straight line. Axes are
/// world axes.
struct Motion {
  Eigen::Vector3d velocity_m_per_s = Eigen::Vector3d::Zero();  ///< of the centre [m/s]
  /// Axis of rotation by the right-hand rule; its length is the rate [rad/s].
  Eigen::Vector3d turn_rad_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_centre_m = Eigen::Vector3d::Zero();  ///< centre at time 0 [m]

  bool is_still() const { return velocity_m_per_s.isZero(0.0) && turn_rad_per_s.isZero(0.0); }
  /// Returns the map from the position of a point at time 0 to its position at time t: c + v t +
  /// R(t) (x - c).
  Eigen::Isometry3d at(double time_s) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule
  void validate(std::string_view field) const;
};

/// Returns a shape moved as a rigid body. Textures of planes, spheres and capsules do not rotate,
/// because their axes are not part of these shapes.
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

/// Returns a scene that needs no files. All except `table-top` are seen along z from the origin.
///
/// | name      | shapes, by index                                                                |
/// |-----------|---------------------------------------------------------------------------------|
/// | table-top | the demo scene: table, wall, three books, ball                                  |
/// | books     | 0 to 2 upright books, front covers at z = 1.2, 1.4, 1.6 m, the first (leftmost) |
/// |           | dark; 3 a wall at 3.2 m; 4 the table                                            |
/// | ball      | 0 a volleyball of radius 20 cm, centre at 1 m; 1 a wall at 2.5 m                |
/// | wall      | 0 a wall at 0.5 m that faces the camera                                         |
/// | corner    | 0 and 1 two walls that meet at a right angle, 3 m ahead, of albedo 0.7          |
/// | room      | as corner, and 2 a floor 1 m below the camera, of albedo 0.4                    |
/// | hand      | capsules only: an open right hand, palm to the camera, 19 cm from the wrist to  |
/// |           | the tip of the middle finger, about 0.5 m away, with its forearm; no background |
/// | moving-   | the hand, 8 cm further left, moving right at 1 m/s, in front of a wall at 1 m   |
/// |  hand     | (the last shape)                                                                |
///
/// @param width, height  resolution of the pinhole camera, > 0
/// @throws std::invalid_argument for an unknown name, with the most similar known one
/// @see Gutierrez-Barragan et al., CVPR 2019, Figs. 7, 10 and 11; sizes that are not in the paper
///      are our choice
StagedScene built_in_scene(std::string_view name, int width = 320, int height = 240);

/// Places a mesh upright and facing a camera that looks along z. By the convention of mesh files,
/// the y axis of the mesh points up.
/// @param scale_m   metres per unit of the mesh, > 0
/// @param centre_m  position of the centre of its bounding box
/// @throws std::invalid_argument if the mesh is a single point
Mesh upright_mesh(TriangleMesh triangles, double scale_m, const Eigen::Vector3d& centre_m);

/// Returns a scene of a single mesh, which fills 80 % of the image's width or height. By the
/// convention of mesh files the camera looks along the mesh's -z axis with y up. The view is 60
/// degrees wide.
/// @param scale_m  metres per unit of the mesh, > 0
/// @param width, height  resolution of the pinhole camera, > 0
/// @throws std::invalid_argument if the mesh or a number is invalid
StagedScene framed_mesh(TriangleMesh triangles, double scale_m, int width, int height);

}  // namespace tofsmith
