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

/// A steady motion: a rigid body turns about a centre that moves straight on. Axes are the world's.
struct Motion {
  Eigen::Vector3d velocity_m_per_s = Eigen::Vector3d::Zero();  ///< of the centre [m/s]
  /// Along the axis it turns about, by the right-hand rule; its length is the rate [rad/s].
  Eigen::Vector3d turn_rad_per_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_centre_m = Eigen::Vector3d::Zero();  ///< the centre at time 0 [m]

  bool is_still() const { return velocity_m_per_s.isZero(0.0) && turn_rad_per_s.isZero(0.0); }
  /// From where a point of the body is at time 0 to where it is then: c + v t + R(t) (x - c).
  Eigen::Isometry3d at(double time_s) const;

  /// @throws std::invalid_argument naming `field`.member, value and rule
  void validate(std::string_view field) const;
};

/// A shape, moved as a rigid body. Textures of planes, spheres and capsules do not turn with them:
/// they keep to axes that these shapes do not say.
Shape moved(const Shape& shape, const Eigen::Isometry3d& motion);

/// A scene, and the place from which it is seen, at time 0.
struct StagedScene {
  std::vector<Shape> shapes;
  PinholeView view;
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();
  Motion camera_motion = {};
  std::vector<Motion> shape_motions = {};  ///< one for each shape; empty: they stand still

  /// Whether anything moves.
  bool is_still() const;
  bool shapes_are_still() const;
  /// The scene as it is then, without motions.
  /// @throws std::invalid_argument if motions are not finite, or not one for each shape
  StagedScene at(double time_s) const;
};

/// Names that built_in_scene knows.
std::vector<std::string> built_in_scene_names();

/// A scene that needs no files. All but `table-top` are seen along z from the origin.
///
/// | name      | shapes, by index                                                               |
/// |-----------|--------------------------------------------------------------------------------|
/// | table-top | the demo's: table, wall, three books, ball                                     |
/// | books     | 0 to 2 upright books, front covers at z = 1.2, 1.4, 1.6 m, the first (leftmost) |
/// |           | dark; 3 a wall at 3.2 m; 4 the table they stand on                             |
/// | ball      | 0 a volleyball of radius 20 cm, centre at 1 m; 1 a wall at 2.5 m               |
/// | wall      | 0 a wall at 0.5 m that faces the camera                                        |
/// | corner    | 0 and 1 two walls that meet at a right angle, 3 m ahead, of albedo 0.7         |
/// | room      | the same, and 2 a floor 1 m below the camera, of albedo 0.4                    |
/// | hand      | capsules only: an open right hand, palm to the camera, 19 cm from the wrist to |
/// |           | the tip of the middle finger, about 0.5 m away, with its forearm; no background |
/// | moving-   | the hand, 8 cm left of there and moving right at 1 m/s, before a wall at 1 m:   |
/// |  hand     | the last shape                                                                 |
///
/// @param width, height  resolution of the pinhole camera, > 0
/// @throws std::invalid_argument for an unknown name, with the nearest known one
/// @see Gutierrez-Barragan et al., CVPR 2019, Figs. 7, 10 and 11; sizes the paper does not give are
///      ours
StagedScene built_in_scene(std::string_view name, int width = 320, int height = 240);

/// A mesh turned as mesh files mean it, y up and front towards a camera that looks along z, with
/// the middle of its box at `centre_m`.
/// @param scale_m  metres per unit of the mesh, > 0
/// @throws std::invalid_argument if the mesh is a single point
Mesh upright_mesh(TriangleMesh triangles, double scale_m, const Eigen::Vector3d& centre_m);

/// A mesh alone in front of a camera that looks along its -z axis with y up, as mesh files mean
/// them, from where it fills 80 % of the image's width or height; the view is 60 degrees wide.
/// @param scale_m  metres per unit of the mesh, > 0
/// @param width, height  resolution of the pinhole camera, > 0
/// @throws std::invalid_argument if the mesh or a number is invalid
StagedScene framed_mesh(TriangleMesh triangles, double scale_m, int width, int height);

}  // namespace tofsmith
