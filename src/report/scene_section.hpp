// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// Depth maps, error maps, their figures and a point cloud.
/// @param best_code  the code whose point cloud is drawn
Section scene_section(const SceneResult& scene, const Camera& camera, const std::string& best_code);

}  // namespace tofsmith
