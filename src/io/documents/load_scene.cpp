// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {

namespace {

namespace fs = std::filesystem;

constexpr int default_width = 320, default_height = 240;

enum class SceneKind { built_in, scene_file, mesh, depth_image };

SceneKind kind_of(const std::string& scene) {
  const std::vector<std::string> names = built_in_scene_names();
  if (std::find(names.begin(), names.end(), scene) != names.end()) return SceneKind::built_in;
  std::error_code ignored;
  if (!fs::exists(scene, ignored) && !fs::path(scene).has_extension()) {
    const std::string near = nearest_word(scene, names);
    throw IoError(scene.empty() ? "scene" : scene,
                  fmt::format("there is no such file and no built-in scene of that name ({}){}",
                              fmt::join(names, ", "),
                              near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  if (fs::path(scene).extension() == ".toml") return SceneKind::scene_file;
  return is_mesh_file(scene) ? SceneKind::mesh : SceneKind::depth_image;
}

void check_fields_fit(const SceneSource& source, SceneKind kind) {
  check_fields(source);
  require(kind == SceneKind::depth_image || source.image.empty(), "image", source.image,
          fmt::format("{} has its own albedo; an albedo image is only valid with a depth image",
                      source.scene));
  if (kind != SceneKind::mesh && source.scale_m)
    reject("scale_m", fmt::format("{}", *source.scale_m),
           "is only valid with a mesh; in a scene file, each [[mesh]] has its own scale_m");
  if (kind == SceneKind::built_in || kind == SceneKind::mesh) return;
  for (const auto& [field, value] :
       {std::pair("width", source.width), std::pair("height", source.height)})
    require(!value, field, value.value_or(0),
            kind == SceneKind::depth_image ? "a depth image has its own size"
                                           : "a scene file specifies its size in [view]");
}

/// Side of the images as specified, or for an optical axis in the middle.
int side_of_lens(std::optional<int> stated, double axis_px, int fallback) {
  constexpr double max_side = 16384;
  const double side = std::round(2.0 * axis_px + 1.0);
  return stated.value_or(side >= 1.0 && side <= max_side ? static_cast<int>(side) : fallback);
}

StagedScene staged_scene(const SceneSource& source, SceneKind kind,
                         const std::optional<Lens>& lens) {
  if (kind == SceneKind::scene_file) return read_scene_toml(source.scene);
  const bool has_pinhole = lens && lens->rays.empty() && !lens->frame_modes;
  const int width = source.width.value_or(
                has_pinhole ? side_of_lens(lens->width_px, lens->cx_px, default_width)
                            : default_width),
            height = source.height.value_or(
                has_pinhole ? side_of_lens(lens->height_px, lens->cy_px, default_height)
                            : default_height);
  StagedScene scene =
      kind == SceneKind::built_in
          ? built_in_scene(source.scene, width, height)
          : framed_mesh(read_mesh(source.scene), source.scale_m.value_or(1.0), width, height);
  if (lens && lens->rays.empty()) scene.view = view_of(lens, width, height);
  return scene;
}

void require_size(const Image<float>& picture, const std::string& file, const SceneImage& scene,
                  const std::string& scene_file) {
  if (picture.height == scene.height() && picture.width == scene.width()) return;
  throw IoError(file,
                fmt::format("is {} x {} pixels; expected {} x {}, the size of {}", picture.height,
                            picture.width, scene.height(), scene.width(), scene_file));
}

Transfer transfer_of(const SceneSource& source) {
  return source.linear_image ? Transfer::linear : Transfer::srgb;
}

LoadedScene depth_image(const SceneSource& source, const std::optional<Lens>& lens) {
  const Image<float> depth_m = read_depth(source.scene);
  LoadedScene scene{fs::path(source.scene).stem().string(),
                    SceneImage(depth_m.height, depth_m.width),
                    view_of(lens, depth_m.width, depth_m.height),
                    {}};
  scene.image.depth_m = depth_kind_of(source.scene, source.kind, DepthKind::z) == DepthKind::z
                            ? radial_from_z(depth_m, rays_of(lens, scene.view))
                            : depth_m;
  if (!source.image.empty()) {
    Image<float> picture = read_albedo(source.image, transfer_of(source));
    require_size(picture, source.image, scene.image, source.scene);
    for (const float value : picture.pixels)
      if (value > scene.brightest_albedo) scene.brightest_albedo = value;
    scene.image.albedo = albedo_of_picture(std::move(picture), source.image, scene.image.depth_m);
  }
  return scene;
}

LoadedScene load(const SceneSource& source, SceneKind kind, const std::optional<Lens>& lens) {
  if (kind == SceneKind::depth_image) return depth_image(source, lens);
  StagedScene staged = staged_scene(source, kind, lens);
  const StagedScene now = staged.at(source.time_s);
  SceneImage image = ray_cast(now.shapes, now.view, now.camera_to_world, embree_search());
  check_view(now, image);
  return {kind == SceneKind::built_in ? source.scene : fs::path(source.scene).stem().string(),
          std::move(image), staged.view, std::move(staged)};
}

}  // namespace

LoadedScene load_scene(const SceneSource& source, const std::optional<Lens>& lens) {
  const SceneKind kind = kind_of(source.scene);
  check_fields_fit(source, kind);
  try {
    LoadedScene scene = load(source, kind, lens);
    if (!source.ambient_image.empty()) {
      scene.image.ambient_scale = read_ambient_scale(source.ambient_image, transfer_of(source));
      require_size(scene.image.ambient_scale, source.ambient_image, scene.image, source.scene);
    }
    scene.image.validate();
    return scene;
  } catch (const std::invalid_argument& error) {  // the error is in a file, not in an argument
    throw IoError(source.scene, error.what());
  }
}

}  // namespace tofsmith
