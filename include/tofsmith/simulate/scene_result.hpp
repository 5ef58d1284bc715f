// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/scene_error.hpp"

namespace tofsmith {

/// One code's depth of one capture.
struct SceneDecoding {
  std::string code;
  Image<float> depth_m;
  SceneError error;
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
/// @throws std::invalid_argument if scene or camera are invalid or a code does not fit; Interrupted
void capture_and_decode(SceneResult& scene, std::span<const CodeSet> codes, const Camera& camera,
                        std::span<const NamedLight> lights, std::uint64_t seed,
                        const Progress& progress = {});

/// Median of the true depths [m]; 1 for a scene without any.
double median_depth_m(const SceneImage& scene);

}  // namespace tofsmith
