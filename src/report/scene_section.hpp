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

/// @param best_code  code of the point cloud
Section scene_section(const SceneResult& scene, const Camera& camera, const std::string& best_code);

/// The scene at the middle light level with a standard code and the best code; none if either is
/// missing.
std::optional<Figure> before_after_figure(const SceneResult& scene, const Camera& camera,
                                          const std::string& best_code);

/// Range of true depths, with a margin.
ValueRange depth_range(const SceneImage& truth, const Camera& camera);

/// Decoded minus true depth; colours are clipped at the limit.
ImageReference error_reference(const SceneImage& truth, const Camera& camera, double limit_mm);

ColouredPoints cloud_of(const PinholeView& view, std::string title, const Image<float>& depth_m);

}  // namespace tofsmith
