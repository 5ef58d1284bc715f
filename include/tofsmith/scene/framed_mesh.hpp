// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/scene/staged_scene.hpp"

namespace tofsmith {

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
