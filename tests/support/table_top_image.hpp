// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

inline SceneImage table_top_image(int width, int height) {
  const StagedScene scene = built_in_scene("table-top", width, height);
  return ray_cast(scene.shapes, scene.view, scene.camera_to_world);
}

}  // namespace tofsmith
