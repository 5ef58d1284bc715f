// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/scene/built_in_scenes.hpp"

namespace tofsmith {

/// Returns the demo scene, after the paper: three upright books on a table, 20 cm apart in depth; a
/// wall 2 m behind the first book; a ball of radius 20 cm about 1.2 m away. Distances are about 1
/// to 4 m.
/// @param width, height  > 0; the view is 60 degrees wide
/// @see Gutierrez-Barragan et al., CVPR 2019, Sec. 6
StagedScene table_top_scene(int width = 320, int height = 240);

}  // namespace tofsmith
