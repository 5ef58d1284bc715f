// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/scene/staged_scene.hpp"

namespace tofsmith {

std::vector<std::string> built_in_scene_names();

/// @param width, height  resolution of the pinhole camera, > 0
/// @throws std::invalid_argument for another name
StagedScene built_in_scene(std::string_view name, int width, int height);

}  // namespace tofsmith
