// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session.hpp"
#include "tofsmith/scene/pinhole.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith::apps {

/// What a command is told about the scene it shall capture.
struct SceneSource {
  std::string depth;              ///< a depth image, or "table-top"
  std::string image;              ///< albedo image; empty: albedo 1
  std::string kind = "z";         ///< of the depth image: "z" or "radial"
  bool linear_image = false;      ///< a PNG holds linear light, not sRGB
  int width = 320, height = 240;  ///< of the built-in scene
};

/// A scene and the pinhole it is seen through.
struct LoadedScene {
  std::string name;
  SceneImage image;
  PinholeView view;
};

/// How an image of this size is seen: through the camera's lens, or 60 degrees wide without one.
PinholeView view_of(const Camera& camera, int width, int height);

/// Loads a depth image with its albedo, or the built-in scene. z-depth becomes radial distance
/// through the camera's lens (without one: a view 60 degrees wide).
/// @throws IoError, std::invalid_argument; UsageError for an albedo image without a depth image
LoadedScene load_scene(const SceneSource& source, const Camera& camera);

}  // namespace tofsmith::apps
