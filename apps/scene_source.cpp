// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/albedo_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/scene/table_top.hpp"

namespace tofsmith::apps {

namespace {

constexpr double default_view_rad = std::numbers::pi / 3;

}  // namespace

PinholeView view_of(const Camera& camera, int width, int height) {
  if (!camera.lens) return PinholeView::centred(width, height, default_view_rad);
  return {camera.lens->fx_px,
          camera.lens->fy_px,
          camera.lens->cx_px,
          camera.lens->cy_px,
          width,
          height};
}

LoadedScene load_scene(const SceneSource& source, const Camera& camera) {
  if (source.depth == "table-top") {
    if (!source.image.empty())
      throw UsageError(fmt::format(
          "--image {}: the built-in table-top scene has its own albedo; give a depth image too",
          source.image));
    StagedScene staged = table_top_scene(source.width, source.height);
    return {"table-top", table_top_image(source.width, source.height), staged.view};
  }
  const Image<float> depth_m = read_depth(source.depth);
  LoadedScene scene{std::filesystem::path(source.depth).stem().string(),
                    SceneImage(depth_m.height, depth_m.width),
                    view_of(camera, depth_m.width, depth_m.height)};
  scene.image.depth_m = source.kind == "z" ? radial_from_z(depth_m, scene.view) : depth_m;
  if (!source.image.empty()) {
    scene.image.albedo =
        read_albedo(source.image, source.linear_image ? Transfer::linear : Transfer::srgb);
    if (scene.image.albedo.height != depth_m.height || scene.image.albedo.width != depth_m.width)
      throw IoError(source.image, fmt::format("is {} x {} pixels; expected {} x {}, the size of {}",
                                              scene.image.albedo.height, scene.image.albedo.width,
                                              depth_m.height, depth_m.width, source.depth));
    // Radiance of a render can exceed 1; as albedo it is scaled down as a whole.
    const float brightest =
        *std::max_element(scene.image.albedo.pixels.begin(), scene.image.albedo.pixels.end());
    if (brightest > 1.0f)
      for (float& value : scene.image.albedo.pixels) value /= brightest;
  }
  scene.image.validate();
  return scene;
}

}  // namespace tofsmith::apps
