// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "output_policy.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith::python {

namespace {

void write_page(const std::string& path, const Page& page, bool overwrite) {
  write_file_atomically(path, render(page), policy_of(overwrite));
}

void write_directory_report(const std::string& directory, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  write_page(path, design_report(read_designed_directory(directory), ""), overwrite);
}

void write_evaluation_report(const std::string& path, const std::vector<CodeSet>& codes,
                             const Camera& camera, const py::list& reports, bool overwrite) {
  std::vector<EvaluatedCode> evaluated;
  for (const py::handle values : reports) {
    DepthErrorReport report = report_of(py::reinterpret_borrow<py::dict>(values));
    if (report.points.size() != camera.operating.points().size())
      refuse("reports", std::to_string(report.points.size()) + " operating points",
             "the camera's " + std::to_string(camera.operating.points().size()));
    evaluated.push_back({std::move(report), 0, {}, {}});
  }
  const py::gil_scoped_release release;
  write_page(path, evaluation_report(camera, codes, evaluated, ""), overwrite);
}

}  // namespace

void bind_reports(py::module_& module) {
  module.def("write_directory_report", &write_directory_report);
  module.def("write_evaluation_report", &write_evaluation_report);
}

}  // namespace tofsmith::python
