// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "lens.hpp"

#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::python {

Lens to_lens(const py::dict& lens) {
  return lens_from_json(py::cast<std::string>(py::module_::import("json").attr("dumps")(lens)));
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
