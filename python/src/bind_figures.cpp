// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "reports.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/point_cloud.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/report/code_figures.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/report/page.hpp"

namespace tofsmith::python {

namespace {

/// Returns a page with a single figure.
std::string page_of(Figure figure) {
  return render({.sections = {{"", {std::move(figure)}, SectionLayout::front}}});
}

FigureText text_of(const std::string& title) { return {.id = "figure", .title = title}; }

ColourScale depth_colours(const std::string& label, bool logarithmic) {
  return {.label = label, .unit = "m", .logarithmic = logarithmic};
}

std::string curves(const std::string& title, const std::vector<std::string>& names,
                   const std::vector<std::vector<double>>& x,
                   const std::vector<std::vector<double>>& y,
                   const std::vector<std::vector<double>>& y_error, const std::string& x_label,
                   const std::string& x_unit) {
  ColourAssignment colours;
  std::vector<Series> series;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Series one{.name = names[i], .x = x.at(i), .y = y.at(i), .y_error = y_error.at(i)};
    one.mark = one.y_error.empty() ? Mark::line : Mark::line_and_markers;
    one.style = one.y_error.empty() ? reference_style() : colours.style(names[i]);
    series.push_back(std::move(one));
  }
  return page_of(line_figure(text_of(title), series,
                             {.label = x_label, .unit = x_unit, .logarithmic = true},
                             {.label = "mean depth error", .unit = "m", .logarithmic = true}));
}

std::string heat_maps(const std::string& title, const std::vector<std::string>& names,
                      const std::vector<Doubles>& values, const std::vector<std::string>& x_ticks,
                      const std::vector<std::string>& y_ticks, const std::string& x_label,
                      const std::string& y_label, const std::string& unit) {
  std::vector<HeatMap> maps;
  for (std::size_t i = 0; i < names.size(); ++i)
    maps.push_back({names[i], to_matrix(values.at(i), "values")});
  return page_of(heat_map_figure(text_of(title), maps, {x_label, unit, x_ticks},
                                 {y_label, unit, y_ticks},
                                 depth_colours("mean depth error", true)));
}

std::string images(const std::string& title, const std::vector<std::string>& names,
                   const py::list& depths_m, bool is_signed) {
  std::vector<ValueImage> pictures;
  for (std::size_t i = 0; i < names.size(); ++i)
    pictures.push_back({names[i], to_image(depths_m[i], "depth_m")});
  ColourScale colours = depth_colours(is_signed ? "depth difference" : "depth", false);
  if (is_signed) colours.map = ColourMap::diverging;
  colours.clip_fraction = 0.005;
  return page_of(image_figure(text_of(title), pictures, colours));
}

std::string point_cloud(const std::string& title, const Floats& points_m, const Floats& values,
                        const std::string& label, const std::string& unit) {
  using Points = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const Eigen::MatrixX3f places = Eigen::Map<const Points>(points_m.data(), points_m.shape(0), 3);
  const Eigen::VectorXf colours = Eigen::Map<const Eigen::VectorXf>(values.data(), values.size());
  return page_of(
      point_cloud_figure(text_of(title), places, colours, {.label = label, .unit = unit}));
}

void write_directory_report(const std::string& directory, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  write_page(path, design_report(read_designed_directory(directory), ""), overwrite);
}

void write_evaluation_report(const std::string& path, const std::vector<CodeSet>& codes,
                             const Camera& camera, const py::list& reports, bool overwrite) {
  std::vector<EvaluatedCode> evaluated;
  for (const py::handle values : reports) {
    DepthErrorReport report =
        fields_from_dict<DepthErrorReport>(py::reinterpret_borrow<py::dict>(values));
    if (report.points.size() != camera.operating.points().size())
      refuse("reports", std::to_string(report.points.size()) + " operating points",
             "the camera's " + std::to_string(camera.operating.points().size()));
    evaluated.push_back({std::move(report), 0, {}, {}});
  }
  const py::gil_scoped_release release;
  write_page(path, evaluation_report(camera, codes, evaluated, ""), overwrite);
}

}  // namespace

void bind_figures(py::module_& module) {
  module.def("waveform_figure",
             [](const std::string& title, const CodeSet& code, const Camera& camera) {
               return page_of(waveform_figure(text_of(title), code, camera));
             });
  module.def("coding_curve_figure",
             [](const std::string& title, const std::vector<CodeSet>& codes, const Camera& camera) {
               return page_of(coding_curve_figure(text_of(title), codes, camera));
             });
  module.def("curve_figure", &curves);
  module.def("heat_map_figure", &heat_maps);
  module.def("image_figure", &images);
  module.def("point_cloud_figure", &point_cloud);
  module.def("write_directory_report", &write_directory_report);
  module.def("write_evaluation_report", &write_evaluation_report);
}

namespace {

/// Returns all frames as (F, H, W, K) floats.
py::array_t<float> read_raw(const std::string& path, const std::optional<int>& measurements,
                            const std::string& layout, const std::optional<std::string>& format,
                            const std::string& dataset) {
  RawReadOptions options;
  options.measurements = measurements;
  options.layout = parse_word<RawLayout>("layout", layout);
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
  if (tap_order) options.layout.order = parse_word<TapOrder>("tap order", *tap_order);
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
