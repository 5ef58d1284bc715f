// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/simulate/staged_capture.hpp"

namespace tofsmith::python {

namespace {

/// Returns the planes of a scene and its lens, by name.
py::dict load(const std::string& name, const py::object& lens, const py::dict& values) {
  SceneSource source{.scene = name};
  OptionReader(values, "").fields(source, {"scene"}).finish();
  const std::optional<Lens> seen_through = to_optional_lens(lens);
  LoadedScene loaded;
  {
    const py::gil_scoped_release release;
    loaded = load_scene(source, seen_through);
  }
  py::dict scene;
  const auto add = [&](const char* plane, Image<float>& values) {
    if (!values.empty()) scene[plane] = adopt(std::move(values));
  };
  add("depth_m", loaded.image.depth_m);
  add("albedo", loaded.image.albedo);
  add("cosine", loaded.image.cosine);
  add("ambient_scale", loaded.image.ambient_scale);
  scene["lens"] = lens_dict(loaded.view);
  return scene;
}

py::array_t<float> convert(const py::object& depth_m, const py::dict& lens,
                           Image<float> (*how)(const Image<float>&, const PixelRays&)) {
  const Image<float> image = to_image(depth_m, "depth_m");
  return adopt(how(image, pixel_rays(lens, image.width, image.height)));
}

/// Returns points of shape (H, W, 3); NaN without depth.
py::array_t<float> points(const py::object& radial_m, const py::dict& lens) {
  const Image<float> radial = to_image(radial_m, "radial_m");
  const PixelRays rays = pixel_rays(lens, radial.width, radial.height);
  std::vector<float> points_m;
  points_m.reserve(3 * radial.size());
  for (int row = 0; row < radial.height; ++row)
    for (int column = 0; column < radial.width; ++column) {
      const Eigen::Vector3f point =
          (rays.ray(row, column) * static_cast<double>(radial(row, column))).cast<float>();
      points_m.insert(points_m.end(), point.begin(), point.end());
    }
  return adopt(std::move(points_m), {radial.height, radial.width, 3});
}

}  // namespace

void bind_scene(py::module_& module) {
  module.def("built_in_scene_names", &built_in_scene_names);
  module.def("load_scene", &load);
  module.def("radial_from_z", [](const py::object& z_m, const py::dict& lens) {
    return convert(z_m, lens, &radial_from_z);
  });
  module.def("z_from_radial", [](const py::object& radial_m, const py::dict& lens) {
    return convert(radial_m, lens, &z_from_radial);
  });
  module.def("points_m", &points);
  module.def("centred_lens", [](int width, int height, double horizontal_angle_rad) {
    return lens_dict(PinholeView::centred(width, height, horizontal_angle_rad));
  });
}

namespace {

std::vector<MultipathReturn> multipath_returns(const Floats& distance_m, const Floats& ratio) {
  if (distance_m.size() != ratio.size())
    refuse("returns.ratio", "shape " + shape_of(ratio),
           "shape " + shape_of(distance_m) + " as of distance_m");
  std::vector<MultipathReturn> returns;
  for (py::ssize_t i = 0; i < ratio.size(); ++i) returns.push_back({distance_m.at(i), ratio.at(i)});
  return returns;
}

MultipathReturns returns_of(const py::tuple& arrays, const SceneImage& scene) {
  const auto first = py::cast<py::array_t<std::int64_t, py::array::c_style>>(arrays[0]);
  MultipathReturns later(scene.height(), scene.width());
  later.first.assign(first.data(), first.data() + first.size());
  later.returns = multipath_returns(py::cast<Floats>(arrays[1]), py::cast<Floats>(arrays[2]));
  const auto pixels = static_cast<py::ssize_t>(scene.height()) * scene.width();
  if (first.size() != pixels + 1)
    refuse("returns.first", "shape " + shape_of(first),
           "shape (" + std::to_string(pixels + 1) + ",), a number for every pixel and the end");
  return later;
}

MultipathReturns behind_of(const Doubles& pairs, const SceneImage& scene) {
  std::vector<MultipathReturn> behind;
  for (py::ssize_t i = 0; i < pairs.shape(0); ++i)
    behind.push_back({static_cast<float>(pairs.at(i, 0)), static_cast<float>(pairs.at(i, 1))});
  return behind_every_pixel(scene, behind);
}

std::vector<Transient> transients_of(const py::tuple& values) {
  const auto bins = py::cast<Doubles>(values[0]);
  std::vector<Transient> transients;
  for (py::ssize_t i = 0; i < bins.shape(0); ++i)
    transients.push_back({{bins.data(i, 0), bins.data(i, 0) + bins.shape(1)},
                          py::cast<double>(values[1]),
                          py::cast<double>(values[2])});
  return transients;
}

SceneLight light_of(const py::dict& values, const SceneImage& scene) {
  SceneLight light;
  if (values.contains("returns")) light.returns = returns_of(values["returns"], scene);
  if (values.contains("behind"))
    light.returns = behind_of(py::cast<Doubles>(values["behind"]), scene);
  if (values.contains("tail")) {
    const py::tuple tail = values["tail"];
    light.tail = {py::cast<double>(tail[0]), py::cast<double>(tail[1])};
  }
  if (values.contains("transients")) light.transients = transients_of(values["transients"]);
  return light;
}

CaptureOptions capture_options(const Camera& camera, const py::dict& values) {
  CaptureOptions options;
  read_options(values, "", options);  // the reference distance
  const OperatingPoint usual = capture_light(camera, options.reference_distance_m);
  options.signal_e_per_s = usual.signal_e_per_s;
  options.ambient_e_per_s = usual.ambient_e_per_s;
  read_options(values, "", options);
  return options;
}

py::array_t<float> capture_array(const py::dict& planes, const py::dict& returns,
                                 const CodeSet& code, const Camera& camera, const py::dict& given,
                                 const py::object& callback) {
  const py::dict values = given.attr("copy")();
  const Image<float> kernel = taken_image(values, "stray_light");
  const CaptureOptions options = capture_options(camera, values);
  const SceneImage scene = scene_of(planes);
  SceneLight light = light_of(returns, scene);
  light.stray_light = kernel;
  return adopt(without_gil(callback, [&](const Progress& progress) {
    return capture(scene, light, code, camera, options, progress);
  }));
}

/// (images, H, W).
template <typename Images, typename ImageOf>
py::array_t<float> stacked(const Images& images, const ImageOf& image_of) {
  const Image<float>& first = image_of(images.front());
  std::vector<float> all;
  for (const auto& each : images)
    all.insert(all.end(), image_of(each).pixels.begin(), image_of(each).pixels.end());
  return adopt(std::move(all),
               {static_cast<py::ssize_t>(images.size()), first.height, first.width});
}

/// Loads a scene by name or file, with a width and height if given.
LoadedScene loaded_scene(const std::string& name, const py::dict& size, const Camera& camera) {
  SceneSource source{.scene = name};
  read_options(size, "", source);
  const py::gil_scoped_release release;
  return load_scene(source, camera.lens);
}

/// Returns the options for indirect light with this camera, as for `simulate --bounce-rays`.
/// @throws std::invalid_argument if the scene has no surfaces out of view
BounceOptions bounce_options(const LoadedScene& scene, const Camera& camera, int rays) {
  if (!scene.staged)
    refuse("scene", "'" + scene.name + "', a depth image",
           "surfaces that light can meet out of view: a built-in scene, a scene file (.toml) or a "
           "mesh");
  BounceOptions options{.rays = rays};
  options.range_m = camera.range_m();
  options.validate();
  return options;
}

py::tuple bounced_light_arrays(const std::string& name, const py::dict& size, const Camera& camera,
                               int rays, const py::object& callback) {
  const LoadedScene scene = loaded_scene(name, size, camera);
  const BounceOptions options = bounce_options(scene, camera, rays);
  MultipathReturns found = without_gil(callback, [&](const Progress& progress) {
    return bounced_light(*scene.staged, options, progress, embree_search());
  });
  std::vector<float> distance_m, ratio;
  for (const MultipathReturn& each : found.returns) {
    distance_m.push_back(each.distance_m);
    ratio.push_back(each.ratio);
  }
  return py::make_tuple(adopt(std::move(found.first)), adopt(std::move(distance_m)),
                        adopt(std::move(ratio)));
}

/// Captures an image directly, or shapes through the camera's lens.
/// @param bounce_rays  0: no indirect light
py::dict capture_staged(const std::string& name, const py::dict& size, const py::dict& returns,
                        int bounce_rays, const CodeSet& code, const Camera& camera,
                        const py::dict& given, const py::object& callback) {
  const py::dict values = given.attr("copy")();
  const Image<float> kernel = taken_image(values, "stray_light");
  const CaptureOptions options = capture_options(camera, values);
  const LoadedScene scene = loaded_scene(name, size, camera);
  std::optional<BounceOptions> bounces;
  if (bounce_rays > 0) bounces = bounce_options(scene, camera, bounce_rays);
  StagedSetup setup{
      .search_of = embree_search(), .light = {}, .ambient_scale = {}, .stray_light = kernel};
  if (!returns.empty() || bounces)
    setup.light = [&](const StagedScene& staged, const SceneImage& rays) {
      SceneLight light;
      if (!returns.empty()) {
        const py::gil_scoped_acquire acquire;
        light = light_of(returns, rays);
      }
      if (bounces) light.returns = bounced_light(staged, *bounces, {}, embree_search());
      return light;
    };
  SceneLight light =
      scene.staged || returns.empty() ? SceneLight{} : light_of(returns, scene.image);
  light.stray_light = kernel;
  StagedCapture made = without_gil(callback, [&](const Progress& progress) {
    if (scene.staged) return capture(*scene.staged, code, camera, options, setup, progress);
    return StagedCapture{.raw = capture(scene.image, light, code, camera, options, progress),
                         .truth = {scene.image},
                         .near_m = {scene.image.depth_m},
                         .far_m = {scene.image.depth_m}};
  });
  const auto own = [](const Image<float>& depth_m) -> const Image<float>& { return depth_m; };
  py::dict result;
  result["depth_m"] = stacked(
      made.truth, [](const SceneImage& seen) -> const Image<float>& { return seen.depth_m; });
  result["near_m"] = stacked(made.near_m, own);
  result["far_m"] = stacked(made.far_m, own);
  result["raw"] = adopt(std::move(made.raw));
  return result;
}

}  // namespace

void bind_capture(py::module_& module) {
  module.def("capture", &capture_array);
  module.def("capture_staged", &capture_staged);
  module.def("bounced_light", &bounced_light_arrays);
}

}  // namespace tofsmith::python
