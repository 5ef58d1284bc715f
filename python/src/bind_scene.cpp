// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "options.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"

namespace tofsmith::python {

namespace {

std::vector<double> lens_list(const PinholeView& view) {
  return {view.fx_px, view.fy_px, view.cx_px, view.cy_px};
}

/// The planes of a scene and its lens, by name.
py::dict load(const std::string& name, const std::optional<std::vector<double>>& lens,
              const py::dict& values) {
  SceneSource source{.scene = name};
  OptionReader(values, "").fields(source, {"scene"}).finish();
  LoadedScene loaded;
  {
    const py::gil_scoped_release release;
    loaded = load_scene(
        source, lens ? std::optional(Lens{lens->at(0), lens->at(1), lens->at(2), lens->at(3)})
                     : std::nullopt);
  }
  py::dict scene;
  const auto add = [&](const char* plane, Image<float>& values) {
    if (!values.empty()) scene[plane] = adopt(std::move(values));
  };
  add("depth_m", loaded.image.depth_m);
  add("albedo", loaded.image.albedo);
  add("cosine", loaded.image.cosine);
  add("ambient_scale", loaded.image.ambient_scale);
  scene["lens"] = lens_list(loaded.view);
  return scene;
}

PinholeView view_of(const std::vector<double>& lens, int width, int height) {
  const PinholeView view{lens.at(0), lens.at(1), lens.at(2), lens.at(3), width, height};
  view.validate();
  return view;
}

py::array_t<float> convert(const py::object& depth_m, const std::vector<double>& lens,
                           Image<float> (*how)(const Image<float>&, const PinholeView&)) {
  const Image<float> image = to_image(depth_m, "depth_m");
  return adopt(how(image, view_of(lens, image.width, image.height)));
}

}  // namespace

void bind_scene(py::module_& module) {
  module.def("built_in_scene_names", &built_in_scene_names);
  module.def("load_scene", &load);
  module.def("radial_from_z", [](const py::object& z_m, const std::vector<double>& lens) {
    return convert(z_m, lens, &radial_from_z);
  });
  module.def("z_from_radial", [](const py::object& radial_m, const std::vector<double>& lens) {
    return convert(radial_m, lens, &z_from_radial);
  });
  module.def("centred_lens", [](int width, int height, double horizontal_angle_rad) {
    return lens_list(PinholeView::centred(width, height, horizontal_angle_rad));
  });
}

}  // namespace tofsmith::python
