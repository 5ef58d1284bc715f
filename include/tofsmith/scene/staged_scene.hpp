// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/shapes.hpp"

namespace tofsmith {

/// A scene, and the place from which it is seen.
struct StagedScene {
  std::vector<Shape> shapes;
  PinholeView view;
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();
};

}  // namespace tofsmith
