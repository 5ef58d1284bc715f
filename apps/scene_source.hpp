// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::apps {

/// Adds all that says how a scene is read, but its name, to a subcommand.
void add_scene_options(CLI::App& command, SceneSource& source);

/// What the scene's argument may be, for help texts.
inline constexpr const char* scene_help =
    "built-in scene (see `tofsmith scene`), scene file (.toml), mesh (.obj .ply .stl), or depth "
    "image (.npy .npz .exr .pfm, .png in mm)";

/// The lens of a view as a setting, to decode what was captured through it: "lens={ fx_px = .. }".
std::string lens_setting(const PinholeView& view);

/// As load_scene(). @throws UsageError for options that do not go with the scene
LoadedScene scene_of(const SceneSource& source, const Camera& camera);

/// That the picture of a scene's albedo was scaled down; "" if it was not.
std::string albedo_remark(const LoadedScene& scene);

/// Light that bounces once between the scene's surfaces, within the camera's range.
/// @throws UsageError for a depth image, which has no surfaces; as bounced_light()
MultipathReturns bounced_light_of(const LoadedScene& scene, const Camera& camera,
                                  BounceOptions options, const Progress& progress);

/// "12.5 % of the depths lie beyond the unambiguous range of 9.99 m and wrap"; "" if none do.
std::string beyond_range_remark(const SceneExtent& extent);

}  // namespace tofsmith::apps
