// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/simulate/bounds.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/interference_error.hpp"
#include "tofsmith/simulate/motion_error.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"

namespace tofsmith::python {

namespace {

/// Reads a struct of options from a dict.
template <typename Options>
Options options_of(const py::dict& values) {
  Options options;
  read_options(values, "", options);
  options.validate();
  return options;
}

/// Binds a function of a code on a camera, whose report becomes a dict.
template <typename Options, typename Report>
auto reporting(Report (*report_of_code)(const CodeSet&, const Camera&, const Options&,
                                        const Progress&),
               py::dict (*to_dict)(const Report&)) {
  return [=](const CodeSet& code, const Camera& camera, const py::dict& values,
             const py::object& callback) {
    const Options options = options_of<Options>(values);
    return to_dict(without_gil(callback, [&](const Progress& progress) {
      return report_of_code(code, camera, options, progress);
    }));
  };
}

/// Returns mae_m at a light level, with the signal scaled uniformly in (0, 1) if requested.
template <typename Bound>
double mae_m(const Bound& bound, double signal_e_per_s, double ambient_e_per_s,
             bool uniform_albedo) {
  const py::gil_scoped_release release;
  const OperatingPoint point{signal_e_per_s, ambient_e_per_s};
  return uniform_albedo ? bound.mae_uniform_albedo_m(point) : bound.mae_m(point);
}

}  // namespace

void bind_simulate(py::module_& module) {
  module.def("evaluate", reporting(&evaluate, &fields_dict<DepthErrorReport>));
  module.def("best_rotation", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                                 const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    BestRotation best = without_gil(callback, [&](const Progress& progress) {
      return best_rotation(code, camera, options, progress);
    });
    return py::make_tuple(best.rotation_bin, adopt(std::move(best.linear_geometric_mean_m)));
  });
  module.def("robustness", reporting(&robustness, &robustness_dict));
  module.def("motion_error", [](const CodeSet& code, const Camera& camera, double velocity_m_per_s,
                                const py::dict& values, const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    return fields_dict(without_gil(callback, [&](const Progress& progress) {
      return motion_error(code, camera, velocity_m_per_s, options, progress);
    }));
  });
  module.def("interference_error",
             reporting(&interference_error, &fields_dict<InterferenceReport>));
  module.def("generator_loss", reporting(&generator_loss, &loss_dict));
  module.def("table_depth_error_m",
             [](const DecodingTable& table, double signal, double ambient_e_per_s,
                std::int64_t trials, std::uint64_t seed) {
               const Estimate error_m = without_gil(py::none(), [&](const Progress&) {
                 return table_depth_error_m(table, {signal, ambient_e_per_s}, trials, seed);
               });
               return py::make_tuple(error_m.value, error_m.standard_error);
             });
  py::class_<CramerRaoBound>(module, "CramerRaoBound")
      .def(py::init([](const CodeSet& code, const Camera& camera, bool of_variance_too) {
        return CramerRaoBound(
            ForwardModel(code, camera), camera,
            of_variance_too ? NoiseInformation::mean_and_variance : NoiseInformation::mean);
      }))
      .def("sigma_m",
           [](const CramerRaoBound& bound, double signal_e_per_s, double ambient_e_per_s) {
             return adopt(bound.sigma_m({signal_e_per_s, ambient_e_per_s}));
           })
      .def("mae_m", &mae_m<CramerRaoBound>);
  py::class_<ReceiverBound>(module, "ReceiverBound")
      .def(py::init<const Camera&, int>())
      .def("mae_m", &mae_m<ReceiverBound>);
  py::class_<HistogramBound>(module, "HistogramBound")
      .def(py::init([](const CodeSet& code, const Camera& camera) {
        return HistogramBound(ForwardModel(code, camera), camera);
      }))
      .def("mae_m", &mae_m<HistogramBound>);
  py::class_<DirectTofBound>(module, "DirectTofBound")
      .def(py::init<const Camera&>())
      .def("mae_m", &mae_m<DirectTofBound>);
}

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
