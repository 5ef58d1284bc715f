// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tofsmith/io/png.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith::apps {

/// A picture to look at: left the depth, near bright and far dark; right what the camera's own
/// light shows, albedo x cosine. Black where nothing returns.
PngImage scene_preview(const SceneImage& scene);

}  // namespace tofsmith::apps
