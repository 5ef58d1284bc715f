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

/// A scene, and the place from which it is seen.
struct StagedScene {
  std::vector<Shape> shapes;
  PinholeView view;
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();
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
