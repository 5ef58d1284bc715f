// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reports.hpp"

#include <pybind11/stl.h>

#include "arrays.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
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

py::tuple pair_of(const Estimate& estimate) {
  return py::make_tuple(estimate.value, estimate.standard_error);
}

py::dict impulse_response_dict(const ImpulseResponse& response) {
  py::dict dict;
  dict["kind"] = std::string(name_of(response.kind));
  if (response.f_max_hz > 0.0) dict["f_max_hz"] = response.f_max_hz;
  if (response.cutoff_hz > 0.0) dict["cutoff_hz"] = response.cutoff_hz;
  if (response.samples.empty()) return dict;
  dict["samples"] = py::tuple(py::cast(response.samples));
  dict["time_step_s"] = response.time_step_s;
  return dict;
}

py::dict loss_dict(const GeneratorLoss& loss) {
  py::dict dict;
  dict["nominal"] = fields_dict(loss.nominal);
  dict["actual"] = fields_dict(loss.actual);
  dict["uncalibrated"] = fields_dict(loss.uncalibrated);
  dict["correlation_change"] = adopt(std::vector<double>(loss.correlation_change));
  return dict;
}

py::dict robustness_dict(const RobustnessReport& report) {
  py::dict dict = fields_dict(report);
  dict["worst_calibrated_m"] = pair_of(report.worst_calibrated_m());
  dict["worst_uncalibrated_m"] = pair_of(report.worst_uncalibrated_m());
  return dict;
}

py::dict operating_multipath_dict(const OperatingMultipathReport& report) {
  py::dict dict;
  const auto add = [&](const std::string& decoded, const OperatingMultipathError& error,
                       bool is_known) {
    for_each_field(error, [&](const auto& mean) {
      dict[py::str(decoded + mean.name)] =
          is_known ? py::object(pair_of(mean.value)) : py::object(py::none());
    });
  };
  add("single_path_", report.single_path, true);
  add("two_return_", report.two_return.value_or(OperatingMultipathError{}),
      report.two_return.has_value());
  return dict;
}

void write_page(const std::filesystem::path& path, const Page& page, bool overwrite) {
  write_file_atomically(path, render(page), policy_of(overwrite));
}

}  // namespace tofsmith::python
