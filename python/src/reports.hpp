// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <string>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/robustness.hpp"
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

/// (value, standard error).
pybind11::tuple pair_of(const Estimate& estimate);

/// Returns a dict without the fields that the kind does not have.
pybind11::dict impulse_response_dict(const ImpulseResponse& response);

/// Convert results to dicts of numbers and arrays, with the names of the C++ fields; values per
/// operating point become arrays with one entry per point.
pybind11::dict loss_dict(const GeneratorLoss& loss);
pybind11::dict robustness_dict(const RobustnessReport& report);
pybind11::dict operating_multipath_dict(const OperatingMultipathReport& report);

/// Renders a page to a file.
void write_page(const std::filesystem::path& path, const Page& page, bool overwrite);

/// Binds the report of a calibration, as a method with the arguments path, source and overwrite.
template <typename Found>
auto writing(Page (*make_page)(const Found& found, const std::string& source,
                               const std::string& command_line)) {
  return [make_page](const Found& found, const std::string& path, const std::string& source,
                     bool overwrite) { write_page(path, make_page(found, source, ""), overwrite); };
}

}  // namespace tofsmith::python
