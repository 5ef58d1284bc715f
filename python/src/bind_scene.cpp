// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "lens.hpp"
#include "options.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"

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

}  // namespace tofsmith::python
