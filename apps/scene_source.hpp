// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "session.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::apps {

/// Arguments that say which scene to capture.
struct SceneSource {
  std::string scene;          ///< a built-in scene, a scene file (.toml), a mesh, or a depth image
  std::string image;          ///< albedo of a depth image; empty: albedo 1
  std::string ambient_image;  ///< ambient light of each pixel; empty: the same everywhere
  std::string kind = "z";     ///< of a depth image: "z" or "radial"
  bool linear_image = false;  ///< PNG images hold linear light, not sRGB
  std::optional<int> width, height;  ///< of built-in scenes and meshes; 320 x 240
  std::optional<double> scale_m;     ///< metres per unit of a mesh; 1
  double time_s = 0.0;               ///< when a scene that moves is looked at

  /// Adds all options but the scene itself to a subcommand.
  void add_to(CLI::App& command);
};

/// What the scene's argument may be, for help texts.
inline constexpr const char* scene_help =
    "built-in scene (see `tofsmith scene`), scene file (.toml), mesh (.obj .ply .stl), or depth "
    "image (.npy .npz .exr .pfm, .png in mm)";

/// A scene and the pinhole it is seen through.
struct LoadedScene {
  std::string name;
  SceneImage image;
  PinholeView view;
  std::optional<StagedScene> staged;  ///< its surfaces; none: a depth image has none
};

/// The lens of a view as a setting, to decode what was captured through it: "lens={ fx_px = .. }".
std::string lens_setting(const PinholeView& view);

/// Loads a depth image with its albedo, or casts the rays of a scene. z-depth becomes radial
/// distance through the camera's lens (without one: a view 60 degrees wide).
/// @throws IoError, std::invalid_argument; UsageError for options that do not go with the scene
LoadedScene load_scene(const SceneSource& source, const Camera& camera);

/// Light that bounces once between the scene's surfaces, within the camera's range.
/// @throws UsageError for a depth image, which has no surfaces; as bounced_light()
MultipathReturns bounced_light_of(const LoadedScene& scene, const Camera& camera,
                                  BounceOptions options, const Progress& progress);

/// "12.5 % of the depths lie beyond the unambiguous range of 9.99 m and wrap"; "" if none do.
std::string beyond_range_remark(const SceneExtent& extent);

}  // namespace tofsmith::apps
