// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::apps {

/// Adds the options that specify how a scene is read, except its name.
void add_scene_options(CLI::App& command, SceneSource& source);

inline constexpr const char* scene_help =
    "built-in scene (see `tofsmith scene`), scene file (.toml), mesh (.obj .ply .stl), or depth "
    "image (.npy .npz .exr .pfm, .png in mm)";

/// Returns the lens of a view as a setting for decoding: "lens={ fx_px = ... }".
std::string lens_setting(const PinholeView& view);

/// Loads a scene (see load_scene()).
/// @throws UsageError for options that do not apply to the scene
LoadedScene scene_of(const SceneSource& source, const Camera& camera);

/// Returns a remark if the albedo image was scaled down; otherwise "".
std::string albedo_remark(const LoadedScene& scene);

/// Returns light that bounces once between the surfaces of the scene, within the camera's range.
/// @throws UsageError for a depth image, which has no surfaces; otherwise as bounced_light()
MultipathReturns bounced_light_of(const LoadedScene& scene, const Camera& camera,
                                  BounceOptions options, const Progress& progress);

/// Returns a remark such as "note: 96 pixels (12.5 % of all pixels with a depth) lie beyond the
/// camera's unambiguous range of 9.99 m: their depth wraps"; "" if there are none.
std::string beyond_range_remark(const SceneExtent& extent);

}  // namespace tofsmith::apps
