// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "lens.hpp"

#include <pybind11/stl.h>

#include <vector>

#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::python {

Lens to_lens(const py::dict& lens) {
  if (lens.contains("rays")) return {.rays = py::cast<std::string>(lens["rays"])};
  const auto number = [&](const char* key) { return py::cast<double>(lens[key]); };
  Lens result{.fx_px = number("fx_px"),
              .fy_px = number("fy_px"),
              .cx_px = number("cx_px"),
              .cy_px = number("cy_px")};
  if (lens.contains("distortion")) {
    LensDistortion& distortion = result.distortion.emplace();
    distortion.coefficients = py::cast<std::vector<double>>(lens["distortion"]);
    if (lens.contains("distortion_model"))
      distortion.model = parse_distortion_model(py::cast<std::string>(lens["distortion_model"]));
  }
  if (lens.contains("width_px")) result.width_px = py::cast<int>(lens["width_px"]);
  if (lens.contains("height_px")) result.height_px = py::cast<int>(lens["height_px"]);
  return result;
}

std::optional<Lens> to_optional_lens(const py::object& lens) {
  return lens.is_none() ? std::nullopt : std::optional(to_lens(py::dict(lens)));
}

py::dict lens_dict(const PinholeView& view) {
  return py::module_::import("json").attr("loads")(lens_to_json(lens_of(view)));
}

PinholeView checked_view(const py::dict& lens, int width, int height) {
  const PinholeView view = view_of(to_lens(lens), width, height);
  view.validate();
  return view;
}

PixelRays pixel_rays(const py::dict& lens, int width, int height) {
  return rays_of(to_lens(lens), checked_view(lens, width, height));
}

}  // namespace tofsmith::python
