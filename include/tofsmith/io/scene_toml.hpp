// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tofsmith/core/fields.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// Reads a scene from TOML, see docs/scenes.md. A texture is a pattern ("checker" or "stripes")
/// with albedo, other_albedo and period_m, or an image (see read_albedo()). An image brighter than
/// 1 is scaled down as a whole, then multiplied by `albedo`; period_m is its width. File names are
/// relative to the scene file.
/// @param settings  keys to override, such as "view.width_px=640"
/// @throws IoError "file:line:column: ..." for invalid TOML, keys, values or files, or a scene
///         without shapes
StagedScene parse_scene_toml(std::string_view text, std::string_view source_name = "scene.toml",
                             std::span<const std::string> settings = {});
StagedScene read_scene_toml(const std::filesystem::path& path,
                            std::span<const std::string> settings = {});

/// Scene by name or file.
struct SceneSource {
  std::string scene;
  std::string image;
  std::string ambient_image;
  std::optional<DepthKind> kind;
  bool linear_image = false;
  std::optional<int> width;
  std::optional<int> height;
  std::optional<double> scale_m;
  double time_s = 0.0;
};
auto fields_of(ConstOrNot<SceneSource> auto& s) {
  return std::tuple(
      Field("scene", s.scene,
            Help{"a built-in scene, a scene file (.toml), a mesh, or a depth image"}),
      Field("image", s.image,
            Help{"image with the albedo of each pixel of a depth image (.png .npy .exr .pfm)"}),
      Field("ambient_image", s.ambient_image,
            Help{"image with the ambient light of each pixel, relative to the ambient light of "
                 "the simulation (.png .npy .exr .pfm)"}),
      Field("kind", s.kind,
            Help{"content of a depth image: z along the optical axis, or radial distance"},
            IfAbsent{"as stated in the file, otherwise z"}),
      Field("linear_image", s.linear_image,
            Help{"treat PNG images as linear light instead of sRGB"}),
      Field("width", s.width, closed(1, 16384), Help{"columns of a built-in scene or a mesh"},
            IfAbsent{"width in the camera's [lens], otherwise 320"}),
      Field("height", s.height, closed(1, 16384), Help{"rows of a built-in scene or a mesh"},
            IfAbsent{"height in the camera's [lens], otherwise 240"}),
      Field("scale_m", s.scale_m, above(0), Help{"length of one unit of a mesh"}, IfAbsent{"1"}),
      Field("time_s", s.time_s, finite(), Help{"time of the image of a moving scene"}));
}

/// A scene and its pinhole view.
struct LoadedScene {
  std::string name;
  SceneImage image;
  PinholeView view;
  std::optional<StagedScene> staged;  ///< at time 0; none for a depth image
  float brightest_albedo = 1.0f;      ///< maximum before scaling, if above 1
};

/// Reads a depth image with its albedo, or casts the rays of a scene. z-depth is converted to
/// radial distance through the lens (default: 60 degrees wide). Built-in scenes and meshes are seen
/// through the lens; without a lens, or with a map of rays, through their own view.
/// @throws InvalidArgument for fields that do not apply to the scene
/// @throws IoError if the scene is unknown or a file is invalid
LoadedScene load_scene(const SceneSource& source, const std::optional<Lens>& lens);

/// Writes a scene and its decodings, but not its ambient scale, into a directory:
///   scene.json                contents and errors
///   true_depth.npy, albedo.npy, cosine.npy
///   LIGHT-CODE.npy            decoded depth [m]; names by file_name_of()
void write_scene_result(const std::filesystem::path& directory, const SceneResult& scene,
                        OutputPolicy policy);

bool holds_scene_result(const std::filesystem::path& directory);

SceneResult read_scene_result(const std::filesystem::path& directory);

/// A finished design and its scene, if any.
struct DesignedDirectory {
  DesignRecord design;
  std::optional<SceneResult> scene;
  std::vector<std::string> files = {};  ///< in the directory, sorted
};

/// Reads the output of `tofsmith design -o` or `tofsmith demo -o`.
/// @throws IoError if there is no finished design, or a file is damaged
DesignedDirectory read_designed_directory(const std::filesystem::path& directory);

}  // namespace tofsmith
