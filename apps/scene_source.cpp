// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "help_pages.hpp"
#include "number_checks.hpp"
#include "tap_arguments.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/mesh_file.hpp"

namespace tofsmith::apps {

void add_scene_options(CLI::App& command, SceneSource& source) {
  command.add_option("--image", source.image, "albedo of a depth image (.png .npy .exr .pfm)");
  command
      .add_option("--ambient-image", source.ambient_image,
                  "ambient light of each pixel, relative to --ambient (.png .npy .exr .pfm)")
      ->group(for_experts);
  command.add_flag("--linear-image", source.linear_image, "PNG images hold linear light, not sRGB")
      ->group(for_experts);
  command
      .add_option_function<std::string>(
          "--kind", [&source](const std::string& word) { source.kind = parse_depth_kind(word); },
          "what a depth image holds: z along the axis, or radial distance")
      ->check(one_of({"z", "radial"}))
      ->default_str("z");
  command.add_option("--width", source.width, "columns of a built-in scene or a mesh (320)")
      ->check(CLI::Range(1, 16384));
  command.add_option("--height", source.height, "rows of a built-in scene or a mesh (240)")
      ->check(CLI::Range(1, 16384));
  command.add_option("--scale-m", source.scale_m, "metres per unit of a mesh (1)")
      ->check(positive_number())
      ->group(for_experts);
}

std::string lens_setting(const PinholeView& view) {
  std::string keys = fmt::format("fx_px = {:.6g}, fy_px = {:.6g}, cx_px = {:.6g}, cy_px = {:.6g}",
                                 view.fx_px, view.fy_px, view.cx_px, view.cy_px);
  if (view.distortion)
    keys += fmt::format(", distortion_model = \"{}\", distortion = [{}]",
                        name_of(view.distortion->model),
                        fmt::join(view.distortion->coefficients, ", "));
  return "lens={ " + keys + " }";
}

LoadedScene scene_of(const SceneSource& source, const Camera& camera) {
  try {
    return load_scene(source, camera.lens);
  } catch (const InvalidArgument& error) {
    std::string option = error.field();
    std::ranges::replace(option, '_', '-');
    throw UsageError(fmt::format("--{} {}: {}", option, error.value(), error.rule()));
  }
}

std::string albedo_remark(const LoadedScene& scene) {
  if (scene.brightest_albedo <= 1.0f) return "";
  return fmt::format(
      "note: the brightest albedo of the picture is {:.4g}, more than all light; all of it was "
      "divided by that",
      scene.brightest_albedo);
}

MultipathReturns bounced_light_of(const LoadedScene& scene, const Camera& camera,
                                  BounceOptions options, const Progress& progress) {
  if (!scene.staged)
    throw UsageError(
        fmt::format("bounced light: found {}, a depth image; expected surfaces that light can meet "
                    "out of view: a built-in scene, a scene file (.toml) or a mesh",
                    scene.name));
  options.range_m = camera.range_m();
  return bounced_light(*scene.staged, options, progress, embree_search());
}

std::string beyond_range_remark(const SceneExtent& extent) {
  if (extent.beyond_range == 0) return "";
  return fmt::format(
      "{} pixels ({:.3g} % of those with a depth) lie beyond the camera's "
      "unambiguous range of {}: their depth wraps",
      extent.beyond_range, 100.0 * extent.beyond_range_share(), length_text(extent.range_m));
}

}  // namespace tofsmith::apps
