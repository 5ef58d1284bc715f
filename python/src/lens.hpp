// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// Converts a dict with the keys of a camera file to a lens.
Lens to_lens(const py::dict& lens);
/// As to_lens(); None is converted to none.
std::optional<Lens> to_optional_lens(const py::object& lens);
/// Returns the lens of a view as a dict.
py::dict lens_dict(const PinholeView& view);
/// Returns the view of images of this size. @throws std::invalid_argument as its validate()
PinholeView checked_view(const py::dict& lens, int width, int height);
/// Returns the rays of that view. @throws IoError also for a file of rays that does not match
PixelRays pixel_rays(const py::dict& lens, int width, int height);

}  // namespace tofsmith::python
