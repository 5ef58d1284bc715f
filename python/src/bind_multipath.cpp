// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith::python {

namespace {

MultipathErrorOptions error_options(const py::dict& values, double range_m) {
  MultipathErrorOptions options;
  OptionReader reader(values, "");
  reader.fields(options, {"decoding"});
  options.decoding = multipath_options(reader.table("decoding"), "decoding", range_m);
  reader.finish();
  options.validate(range_m);
  return options;
}

py::dict cells_dict(const std::vector<MultipathCell>& cells) {
  py::dict dict;
  add_columns(dict, cells);
  return dict;
}

py::dict error_dict(const MultipathErrorReport& report) {
  py::list maps;
  for (const MultipathMaps& map : report.maps) {
    py::dict dict;
    dict["signal_e_per_s"] = map.signal_e_per_s;
    dict["points"] = cells_dict(map.points);
    dict["tails"] = cells_dict(map.tails);
    dict["single"] = cells_dict({map.single});
    dict["single_by_tail"] = cells_dict({map.single_by_tail});
    maps.append(dict);
  }
  py::dict dict;
  dict["code"] = report.code;
  dict["measurements"] = report.measurements;
  dict["why_no_two_returns"] = report.why_no_two_returns;
  dict["why_no_tail"] = report.why_no_tail;
  dict["maps"] = maps;
  return dict;
}

void bind_bound(py::module_& module) {
  py::class_<MultipathBound>(module, "MultipathBound")
      .def(py::init([](const CodeSet& code, const Camera& camera) {
        return MultipathBound(ForwardModel(code, camera), camera);
      }))
      .def("sigma_m",
           [](const MultipathBound& bound, double signal_e_per_s, double ambient_e_per_s,
              double ratio, double delay_m) {
             return adopt(bound.sigma_m({signal_e_per_s, ambient_e_per_s}, ratio, delay_m));
           })
      .def("tail_sigma_m",
           [](const MultipathBound& bound, double signal_e_per_s, double ambient_e_per_s,
              double mean_delay_m, double ratio) {
             return adopt(
                 bound.tail_sigma_m({signal_e_per_s, ambient_e_per_s}, {mean_delay_m, ratio}));
           })
      .def("mae_m", [](const MultipathBound& bound, const Doubles& sigma_m) {
        return bound.mae_m(to_vector(sigma_m));
      });
}

}  // namespace

void bind_multipath(py::module_& module) {
  bind_bound(module);
  module.def("single_path_bias_m", &single_path_bias_m);
  module.def("multipath_error", [](const CodeSet& code, const Camera& camera,
                                   const py::dict& values, const py::object& callback) {
    const MultipathErrorOptions options = error_options(values, camera.range_m());
    return error_dict(without_gil(callback, [&](const Progress& progress) {
      return multipath_error(code, camera, options, progress);
    }));
  });
}

}  // namespace tofsmith::python
