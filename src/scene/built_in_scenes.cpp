// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/built_in_scenes.hpp"

#include "tofsmith/core/error.hpp"
#include "tofsmith/scene/table_top.hpp"

namespace tofsmith {

std::vector<std::string> built_in_scene_names() { return {"table-top"}; }

StagedScene built_in_scene(std::string_view name, int width, int height) {
  require(name == "table-top", "scene", name, "must be a built-in scene");
  return table_top_scene(width, height);
}

}  // namespace tofsmith
