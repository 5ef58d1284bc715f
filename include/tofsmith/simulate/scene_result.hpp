// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/depth_error.hpp"

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
                       DepthErrorKind kind,
                       double outlier_threshold_m = default_outlier_threshold_m);

/// How an image of this size is seen: through the lens, or 60 degrees wide without one.
/// @throws std::invalid_argument if the lens is of images of another size
PinholeView view_of(const std::optional<Lens>& lens, int width, int height);
/// The lens of a view, of images of any size.
Lens lens_of(const PinholeView& view);

/// How far away the parts of a scene are, for a camera.
struct SceneExtent {
  std::int64_t pixels = 0;        ///< in all
  std::int64_t returns = 0;       ///< with a depth
  std::int64_t beyond_range = 0;  ///< of these, at or beyond the unambiguous range
  double nearest_m = 0.0;         ///< radial; 0 of no returns
  double median_m = 0.0;
  double farthest_m = 0.0;
  double range_m = 0.0;  ///< unambiguous range of the camera

  double no_return_share() const;     ///< of all pixels
  double beyond_range_share() const;  ///< of the pixels with a depth
};

SceneExtent scene_extent(const SceneImage& scene, const Camera& camera);

/// 1 where depth is at or beyond the camera's unambiguous range: what it measures there is wrapped
/// and looks like a nearer surface. 0 elsewhere and where nothing returns.
Image<std::uint8_t> beyond_range(const SceneImage& scene, const Camera& camera);

/// The same raw numbers once more, filtered before they are decoded.
struct FilteredSceneDecoding {
  Image<float> depth_m;
  Image<float> averaged;  ///< of how many measurements numbers are the mean, as FilteredFrame
  SceneError error;
};

/// One code's depth of one capture.
struct SceneDecoding {
  std::string code;
  Image<float> depth_m;
  SceneError error;
  std::optional<FilteredSceneDecoding> filtered = {};
};

/// A scene captured at one light level and decoded with several codes.
struct SceneCapture {
  std::string light;  ///< "low", "medium", "high"
  OperatingPoint point;
  std::vector<SceneDecoding> decodings;
};

/// What became of a scene.
struct SceneResult {
  std::string name;
  SceneImage truth;
  PinholeView view;
  double reference_distance_m = 1.0;  ///< where albedo 1 returns the signal of an operating point
  std::vector<SceneCapture> captures;
};

/// A light level with its name.
struct NamedLight {
  std::string name;
  OperatingPoint point;
};

/// Captures and decodes `scene` with every code at every light level and fills its captures.
/// Codes see the same noise, drawn from `seed`.
/// @param filter  with which measurements are also filtered; none: they are not
/// @throws std::invalid_argument if scene or camera are invalid or a code does not fit; Interrupted
void capture_and_decode(SceneResult& scene, std::span<const CodeSet> codes, const Camera& camera,
                        std::span<const NamedLight> lights, std::uint64_t seed,
                        const std::optional<FilterOptions>& filter = {},
                        const Progress& progress = {});

/// Median of the true depths [m]; 1 for a scene without any.
double median_depth_m(const SceneImage& scene);

}  // namespace tofsmith
