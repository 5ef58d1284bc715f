// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "field_dicts.hpp"
#include "reports.hpp"
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

std::string points(const std::string& title, const Floats& points_m, const Floats& values,
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
  module.def("point_cloud_figure", &points);
  module.def("write_directory_report", &write_directory_report);
  module.def("write_evaluation_report", &write_evaluation_report);
}

}  // namespace tofsmith::python
