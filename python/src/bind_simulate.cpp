// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/simulate/depth_error.hpp"
#include "tofsmith/simulate/interference_error.hpp"
#include "tofsmith/simulate/motion_error.hpp"
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

}  // namespace

void bind_simulate(py::module_& module) {
  module.def("evaluate", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                            const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    return report_dict(without_gil(callback, [&](const Progress& progress) {
      return evaluate(code, camera, options, progress);
    }));
  });
  module.def("best_rotation", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                                 const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    BestRotation best = without_gil(callback, [&](const Progress& progress) {
      return best_rotation(code, camera, options, progress);
    });
    return py::make_tuple(best.rotation_bin, adopt(std::move(best.linear_geometric_mean_m)));
  });
  module.def("robustness", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                              const py::object& callback) {
    const RobustnessOptions options = options_of<RobustnessOptions>(values);
    return robustness_dict(without_gil(callback, [&](const Progress& progress) {
      return robustness(code, camera, options, progress);
    }));
  });
  module.def("motion_error", [](const CodeSet& code, const Camera& camera, double velocity_m_per_s,
                                const py::dict& values, const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    return fields_dict(without_gil(callback, [&](const Progress& progress) {
      return motion_error(code, camera, velocity_m_per_s, options, progress);
    }));
  });
  module.def("interference_error", [](const CodeSet& code, const Camera& camera,
                                      const py::dict& values, const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    return fields_dict(without_gil(callback, [&](const Progress& progress) {
      return interference_error(code, camera, options, progress);
    }));
  });
  module.def("generator_loss", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                                  const py::object& callback) {
    const EvaluateOptions options = options_of<EvaluateOptions>(values);
    return loss_dict(without_gil(callback, [&](const Progress& progress) {
      return generator_loss(code, camera, options, progress);
    }));
  });
  module.def("table_depth_error_m",
             [](const DecodingTable& table, double signal, double ambient_e_per_s,
                std::int64_t trials, std::uint64_t seed) {
               const Estimate error_m = without_gil(py::none(), [&](const Progress&) {
                 return table_depth_error_m(table, {signal, ambient_e_per_s}, trials, seed);
               });
               return py::make_tuple(error_m.value, error_m.standard_error);
             });
}

}  // namespace tofsmith::python
