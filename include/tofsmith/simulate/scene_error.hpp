// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/array.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

/// How far a decoded frame is from the scene, over the pixels that have a true depth.
struct SceneError {
  double mean_m = 0.0;         ///< mean |decoded - true|, pixels without decoded depth left out
  double median_m = 0.0;       ///< median of the same
  double outlier_rate = 0.0;   ///< share beyond the threshold or without decoded depth
  double decoded_share = 0.0;  ///< share of pixels that got a depth
  std::int64_t pixels = 0;     ///< with a true depth
  double outlier_threshold_m = 0.0;
};

/// True distance as the camera can see it: wrapped into the range; NaN = no return.
Image<float> wrapped_depth_m(const SceneImage& scene, const Camera& camera);

/// decoded - true [m], the linear or the circular difference; NaN where either is unknown.
/// @throws std::invalid_argument if the sizes differ
Image<float> depth_difference_m(const Image<float>& decoded_m, const SceneImage& scene,
                                const Camera& camera, DepthErrorKind kind);

/// Summary of the differences. @throws std::invalid_argument if the sizes differ
SceneError scene_error(const Image<float>& decoded_m, const SceneImage& scene, const Camera& camera,
                       DepthErrorKind kind, double outlier_threshold_m = 0.3);

}  // namespace tofsmith
