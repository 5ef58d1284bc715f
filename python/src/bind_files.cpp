// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "options.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/point_cloud.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith::python {

namespace {

/// Returns all frames as (F, H, W, K) floats.
py::array_t<float> read_raw(const std::string& path, const std::optional<int>& measurements,
                            const std::string& layout, const std::optional<std::string>& format,
                            const std::string& dataset) {
  RawReadOptions options;
  options.measurements = measurements;
  options.layout = parse_raw_layout(layout);
  if (format) options.format = read_raw_format(*format);
  options.dataset = dataset;
  RawFrames all;
  {
    const py::gil_scoped_release release;
    all = read_raw_frames(std::vector<std::filesystem::path>{path}, options);
  }
  return adopt(std::move(all));
}

void write_raw(const std::string& path, const py::object& values, bool overwrite) {
  write_raw_frames(path, to_raw_frames(values, "raw"), policy_of(overwrite));
}

py::tuple read_table(const std::string& path, int taps, const std::optional<std::string>& tap_order,
                     const std::optional<std::string>& axes, bool keep_end_point) {
  MeasuredTableOptions options;
  options.layout.taps = taps;
  if (tap_order) options.layout.order = parse_tap_order(*tap_order);
  if (axes) options.axes = parse_table_axes(*axes);
  options.keep_end_point = keep_end_point;
  MeasuredTableFile file = read_measured_table(path, options);
  return py::make_tuple(adopt(std::move(file.table.correlation)), file.notes);
}

void write_points(const std::string& path, const Floats& points_m, const py::dict& scalars,
                  bool overwrite) {
  PointCloud cloud;
  for (py::ssize_t i = 0; i < points_m.shape(0); ++i)
    cloud.points_m.push_back({points_m.at(i, 0), points_m.at(i, 1), points_m.at(i, 2)});
  for (const auto& entry : scalars) {
    const auto values = py::cast<Floats>(entry.second);
    cloud.scalars.push_back({py::cast<std::string>(entry.first),
                             std::vector<float>(values.data(), values.data() + values.size())});
  }
  write_ply(path, cloud, policy_of(overwrite));
}

}  // namespace

void bind_files(py::module_& module) {
  module.def("read_raw", &read_raw);
  module.def("write_raw", &write_raw);
  module.def("read_depth", [](const std::string& path) { return adopt(read_depth(path)); });
  module.def("write_depth", [](const std::string& path, const py::object& depth_m, bool overwrite) {
    write_depth(path, to_image(depth_m, "depth_m"), policy_of(overwrite));
  });
  module.def("read_correlation_functions",
             [](const std::string& path) { return adopt(read_correlation_functions(path)); });
  module.def("read_measured_table", &read_table);
  module.def("write_points", &write_points);
  module.def("read_impulse_response",
             [](const std::string& path, const std::optional<double>& time_step_s) {
               ImpulseResponse response = read_impulse_response(path, time_step_s);
               return py::make_tuple(adopt(std::move(response.samples)), response.time_step_s);
             });
}

}  // namespace tofsmith::python
