// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// Depth maps, error maps, a table of errors and a point cloud.
/// @param best_code  the code whose point cloud is drawn
Section scene_section(const SceneResult& scene, const Camera& camera, const std::string& best_code);

/// The scene at the middle light level, decoded with a standard code and with the best; none
/// without captures of both.
std::optional<Figure> before_after_figure(const SceneResult& scene, const Camera& camera,
                                          const std::string& best_code);

/// Smallest and largest true depth, with a little room.
ValueRange depth_range(const SceneImage& truth, const Camera& camera);

/// Decoded minus true depth; white is right, the colours end at the limit.
ImageReference error_reference(const SceneImage& truth, const Camera& camera, double limit_mm);

/// Every pixel at its place in front of the camera, coloured by depth.
ColouredPoints cloud_of(const PinholeView& view, std::string title, const Image<float>& depth_m);

}  // namespace tofsmith
