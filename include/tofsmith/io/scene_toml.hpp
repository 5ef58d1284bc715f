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

/// Reads a scene from TOML: shapes, and the pinhole camera that sees them. The world's axes are
/// x to the right, y down and z forward [m]; so are the camera's own.
///
///   [view]      width_px, height_px (320 x 240); horizontal_angle_deg (60), or fx_px with fy_px
///               (= fx_px), cx_px and cy_px (the middle), distortion_model and distortion
///               as in a camera's [lens]
///   [camera]    position_m (the origin); look_at_m, or rotation_deg
///   [[plane]]   point_m, normal
///   [[box]]     centre_m, size_m, rotation_deg
///   [[sphere]]  centre_m, radius_m
///   [[capsule]] start_m, end_m, radius_m
///   [[mesh]]    file (see read_mesh()), scale_m (1; metres per unit), position_m, rotation_deg
///
/// rotation_deg = [x, y, z] turns about the world's x axis first, then y, then z, by the right-hand
/// rule. Every shape takes albedo (0.5), or texture, one of
///
///   { pattern = "checker", albedo = 0.8, other_albedo = 0.2, period_m = 0.1 }, or "stripes"
///   { image = "cover.png", linear = false, albedo = 1, period_m = 0.1 }   see read_albedo();
///         scaled as a whole if brighter than 1; albedo multiplies it, period_m is its width
///
/// Shapes and the camera may move steadily, as Motion says: velocity_m_per_s = [x, y, z];
/// turn_deg_per_s = [x, y, z], the axis times the rate, about turn_centre_m, which moves along
/// (a shape's middle: point_m, centre_m, position_m or the middle of a capsule; the camera itself).
///
/// Files are named from where the scene stands.
/// @param source_name  path of the file, or what errors shall call it
/// @param settings  keys that replace those of the file, such as "view.width_px=640"
/// @throws IoError "file:line:column: .." for what is no TOML, unknown keys (with the nearest
///         known one), wrong types, missing and contradictory keys, values out of range, and
///         meshes and images that cannot be read; or if there is no shape
StagedScene parse_scene_toml(std::string_view text, std::string_view source_name = "scene.toml",
                             std::span<const std::string> settings = {});
/// @throws IoError as parse_scene_toml(), or if the file cannot be read
StagedScene read_scene_toml(const std::filesystem::path& path,
                            std::span<const std::string> settings = {});

/// Which scene is seen, by name or file.
struct SceneSource {
  std::string scene;
  std::string image;
  std::string ambient_image;
  DepthKind kind = DepthKind::z;
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
      Field("kind", s.kind, Help{"content of a depth image: z along the axis, or radial distance"}),
      Field("linear_image", s.linear_image, Help{"take PNG images as linear light, not sRGB"}),
      Field("width", s.width, closed(1, 16384), Help{"columns of a built-in scene or a mesh"},
            IfAbsent{"320"}),
      Field("height", s.height, closed(1, 16384), Help{"rows of a built-in scene or a mesh"},
            IfAbsent{"240"}),
      Field("scale_m", s.scale_m, above(0), Help{"length of one unit of a mesh"}, IfAbsent{"1"}),
      Field("time_s", s.time_s, finite(), Help{"when a scene that moves is looked at"}));
}

/// A scene and the pinhole it is seen through.
struct LoadedScene {
  std::string name;
  SceneImage image;
  PinholeView view;
  std::optional<StagedScene> staged;  ///< its surfaces at time 0; none: a depth image has none
  float brightest_albedo = 1.0f;      ///< above 1: a picture's, by which all of it was divided
};

/// Reads a depth image with its albedo, or casts the rays of a scene. z-depth becomes radial
/// distance through the lens (without one: a view 60 degrees wide).
/// @throws InvalidArgument for fields that do not go with the scene; IoError for what is no scene
///         and for files that do not hold what they should
LoadedScene load_scene(const SceneSource& source, const std::optional<Lens>& lens);

/// Writes a scene and its decodings into a directory:
///   scene.json                what is there, with the errors
///   true_depth.npy, albedo.npy, cosine.npy
///   LIGHT-CODE.npy            decoded depth [m], of file_name_of() their names
/// What scales ambient light, if anything does, is not kept.
/// @throws IoError
void write_scene_result(const std::filesystem::path& directory, const SceneResult& scene,
                        OutputPolicy policy);

/// Whether write_scene_result() has finished here.
bool holds_scene_result(const std::filesystem::path& directory);

/// @throws IoError naming the file and what is wrong with it
SceneResult read_scene_result(const std::filesystem::path& directory);

/// A finished design and the scene it was tried on, if there is one.
struct DesignedDirectory {
  DesignRecord design;
  std::optional<SceneResult> scene;
  std::vector<std::string> files = {};  ///< names in the directory, sorted
};

/// Reads what `tofsmith design -o` or `tofsmith demo -o` left in a directory.
/// @throws IoError naming the directory if it holds no finished design, or the damaged file
DesignedDirectory read_designed_directory(const std::filesystem::path& directory);

}  // namespace tofsmith
