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

/// Reads a scene from TOML: shapes, and the pinhole camera that views them. The axes of world and
/// camera are x to the right, y down and z forward [m]. Defaults are in brackets.
///
///   [view]      width_px, height_px (320 x 240); horizontal_angle_deg (60), or fx_px with fy_px
///               (= fx_px), cx_px and cy_px (the centre), distortion_model and distortion
///               as in a camera's [lens]
///   [camera]    position_m (the origin); look_at_m, or rotation_deg
///   [[plane]]   point_m, normal
///   [[box]]     centre_m, size_m, rotation_deg
///   [[sphere]]  centre_m, radius_m
///   [[capsule]] start_m, end_m, radius_m
///   [[mesh]]    file (see read_mesh()), scale_m (1; metres per unit), position_m, rotation_deg
///
/// rotation_deg = [x, y, z] rotates about the world's x axis first, then y, then z, by the
/// right-hand rule. Every shape has an albedo (0.5) or a texture, one of
///
///   { pattern = "checker", albedo = 0.8, other_albedo = 0.2, period_m = 0.1 }, or "stripes"
///   { image = "cover.png", linear = false, albedo = 1, period_m = 0.1 }   see read_albedo()
///
/// An image brighter than 1 is scaled down as a whole, then multiplied by `albedo`; period_m is its
/// width. Shapes and the camera may move at constant velocity (see Motion): velocity_m_per_s = [x,
/// y, z]; turn_deg_per_s = [x, y, z], the axis times the rate, about turn_centre_m, which moves
/// with the shape. It defaults to the centre of a shape (point_m, centre_m, position_m or the
/// middle of a capsule) or to the camera's position. File names are relative to the scene file.
/// @param source_name  path, or name for error messages
/// @param settings  keys to override, such as "view.width_px=640"
/// @throws IoError "file:line:column: ..." for invalid TOML, unknown keys (with the most similar
///         known key), wrong types, missing or contradictory keys, values out of range, meshes and
///         images that cannot be read, or a scene without shapes
StagedScene parse_scene_toml(std::string_view text, std::string_view source_name = "scene.toml",
                             std::span<const std::string> settings = {});
/// @throws IoError as parse_scene_toml(), or if the file cannot be read
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
      Field("image", s.image, Help{"albedo of a depth image (.png .npy .exr .pfm)"}),
      Field("ambient_image", s.ambient_image,
            Help{"ambient light of each pixel, relative to that of the capture (.png .npy .exr "
                 ".pfm)"}),
      Field("kind", s.kind, Help{"content of a depth image: z along the axis, or radial distance"},
            IfAbsent{"as the file states, or z"}),
      Field("linear_image", s.linear_image,
            Help{"treat PNG images as linear light instead of sRGB"}),
      Field("width", s.width, closed(1, 16384), Help{"columns of a built-in scene or a mesh"},
            IfAbsent{"as the camera's [lens], or 320"}),
      Field("height", s.height, closed(1, 16384), Help{"rows of a built-in scene or a mesh"},
            IfAbsent{"as the camera's [lens], or 240"}),
      Field("scale_m", s.scale_m, above(0), Help{"length of one unit of a mesh"}, IfAbsent{"1"}),
      Field("time_s", s.time_s, finite(), Help{"time of the image of a moving scene"}));
}

/// A scene and the pinhole view of it.
struct LoadedScene {
  std::string name;
  SceneImage image;
  PinholeView view;
  std::optional<StagedScene> staged;  ///< its surfaces at time 0; none for a depth image
  float brightest_albedo = 1.0f;      ///< maximum albedo of an image before scaling, if above 1
};

/// Reads a depth image with its albedo, or casts the rays of a scene. z-depth is converted to
/// radial distance through the lens (default: a view 60 degrees wide). Built-in scenes and meshes
/// are seen through the lens; without a lens, or with a map of rays, through the view of the scene.
/// @throws InvalidArgument for fields that do not apply to the scene
/// @throws IoError if the scene is unknown or a file has invalid content
LoadedScene load_scene(const SceneSource& source, const std::optional<Lens>& lens);

/// Writes a scene and its decodings into a directory:
///   scene.json                contents and errors
///   true_depth.npy, albedo.npy, cosine.npy
///   LIGHT-CODE.npy            decoded depth [m]; the names are encoded by file_name_of()
/// The ambient scale of the scene is not written.
/// @throws IoError
void write_scene_result(const std::filesystem::path& directory, const SceneResult& scene,
                        OutputPolicy policy);

/// Returns true if write_scene_result() has completed in the directory.
bool holds_scene_result(const std::filesystem::path& directory);

/// @throws IoError naming the file and the error
SceneResult read_scene_result(const std::filesystem::path& directory);

/// A finished design and the scene that it was evaluated on, if any.
struct DesignedDirectory {
  DesignRecord design;
  std::optional<SceneResult> scene;
  std::vector<std::string> files = {};  ///< names in the directory, sorted
};

/// Reads the output of `tofsmith design -o` or `tofsmith demo -o`.
/// @throws IoError naming the directory if it contains no finished design, or the damaged file
DesignedDirectory read_designed_directory(const std::filesystem::path& directory);

}  // namespace tofsmith
