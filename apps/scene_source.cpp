// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_source.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/mesh_file.hpp"

namespace tofsmith::apps {

void add_scene_options(CLI::App& command, SceneSource& source) {
  const FieldOptions fields(command, source);
  fields.add("image");
  fields.add("ambient_image")->group(for_experts);
  fields.add("linear_image")->group(for_experts);
  fields.add("kind");
  fields.add("width");
  fields.add("height");
  fields.add("scale_m")->group(for_experts);
}

std::string lens_setting(const PinholeView& view) {
  std::string keys = fmt::format("fx_px = {:.6g}, fy_px = {:.6g}, cx_px = {:.6g}, cy_px = {:.6g}",
                                 view.fx_px, view.fy_px, view.cx_px, view.cy_px);
  if (view.distortion)
    keys += fmt::format(", distortion_model = \"{}\", distortion = [{}]",
                        name_of(view.distortion->model),
                        fmt::join(view.distortion->coefficients, ", "));
  if (view.distortion && view.distortion->max_radius)
    keys += fmt::format(", distortion_max_radius = {}", *view.distortion->max_radius);
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
      "note: the largest albedo of the image is {:.4g}, above 1; all albedos were divided by it",
      scene.brightest_albedo);
}

MultipathReturns bounced_light_of(const LoadedScene& scene, const Camera& camera,
                                  BounceOptions options, const Progress& progress) {
  if (!scene.staged)
    throw UsageError(
        fmt::format("bounced light: found {}, a depth image; expected a scene with surfaces "
                    "outside the view: a built-in scene, a scene file (.toml) or a mesh",
                    scene.name));
  options.range_m = camera.range_m();
  return bounced_light(*scene.staged, options, progress, embree_search());
}

std::string beyond_range_remark(const SceneExtent& extent) {
  if (extent.beyond_range == 0) return "";
  return fmt::format(
      "note: {} pixels ({:.3g} % of all pixels with a depth) lie beyond the camera's unambiguous "
      "range of {}: their depth wraps{}",
      extent.beyond_range, 100.0 * extent.beyond_range_share(), length_text(extent.range_m),
      extent.beyond_range_share() == 1.0 ? "; check that the depth is in metres" : "");
}

}  // namespace tofsmith::apps
