// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::python {

namespace py = pybind11;

/// A lens from a dict of the keys of a camera file.
Lens to_lens(const py::dict& lens);
/// None of None.
std::optional<Lens> to_optional_lens(const py::object& lens);
/// The lens of a view as such a dict.
py::dict lens_dict(const PinholeView& view);
/// What an image of this size is seen through. @throws std::invalid_argument as its validate()
PinholeView checked_view(const py::dict& lens, int width, int height);
/// Its rays. @throws IoError also for a file of rays that does not fit
PixelRays pixel_rays(const py::dict& lens, int width, int height);

}  // namespace tofsmith::python
