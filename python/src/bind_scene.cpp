// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "tofsmith/camera/camera.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith::python {

namespace {

/// The planes of a scene and its lens, by name.
py::dict seen(const StagedScene& at_start, double time_s) {
  const StagedScene staged = at_start.at(time_s);
  SceneImage image;
  {
    const py::gil_scoped_release release;
    image = ray_cast(staged.shapes, staged.view, staged.camera_to_world, embree_search());
    check_view(staged, image);
  }
  py::dict scene;
  scene["depth_m"] = adopt(std::move(image.depth_m));
  scene["albedo"] = adopt(std::move(image.albedo));
  scene["cosine"] = adopt(std::move(image.cosine));
  scene["lens"] = std::vector<double>{staged.view.fx_px, staged.view.fy_px, staged.view.cx_px,
                                      staged.view.cy_px};
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
  module.def("built_in_scene", [](const std::string& name, int width, int height, double time_s) {
    return seen(built_in_scene(name, width, height), time_s);
  });
  module.def("read_scene", [](const std::string& path, double time_s) {
    return seen(read_scene_toml(path), time_s);
  });
  module.def("radial_from_z", [](const py::object& z_m, const std::vector<double>& lens) {
    return convert(z_m, lens, &radial_from_z);
  });
  module.def("z_from_radial", [](const py::object& radial_m, const std::vector<double>& lens) {
    return convert(radial_m, lens, &z_from_radial);
  });
  module.def("centred_lens", [](int width, int height, double horizontal_angle_rad) {
    const PinholeView view = PinholeView::centred(width, height, horizontal_angle_rad);
    return std::vector<double>{view.fx_px, view.fy_px, view.cx_px, view.cy_px};
  });
}

}  // namespace tofsmith::python
