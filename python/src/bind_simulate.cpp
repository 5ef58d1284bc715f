// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/simulate/generator_loss.hpp"
#include "tofsmith/simulate/table_depth_error.hpp"

namespace tofsmith::python {

namespace {

DepthSampling parse_depth_sampling(const std::string& word) {
  if (word == "uniform") return DepthSampling::uniform;
  if (word == "bins") return DepthSampling::bins;
  refuse("depth", "'" + word + "'", "uniform or bins");
}

EvaluateOptions evaluate_options(const py::dict& values) {
  EvaluateOptions options;
  OptionReader(values, "")
      .value("trials", options.trials)
      .value("seed", options.seed)
      .value("outlier_threshold_m", options.outlier_threshold_m)
      .value("sub_bin", options.sub_bin)
      .word("depth", options.depth, parse_depth_sampling)
      .value("clip_to_open_sensor", options.clip_to_open_sensor)
      .word("method", options.method, parse_decode_method)
      .word("unwrap_weights", options.unwrap_weights, parse_unwrap_weights)
      .value("target_standard_error", options.target_standard_error)
      .value("most_trials", options.most_trials)
      .value("draw_every_measurement", options.draw_every_measurement)
      .finish();
  options.validate();
  return options;
}

RobustnessOptions robustness_options(const py::dict& values) {
  RobustnessOptions options;
  OptionReader(values, "")
      .value("bandwidth", options.bandwidth)
      .value("peak", options.peak)
      .value("edge_jitter_s", options.edge_jitter_s)
      .value("tap_mismatch", options.tap_mismatch)
      .value("clock_s", options.clock_s)
      .value("droop", options.droop)
      .value("together", options.together)
      .value("trials", options.trials)
      .value("seed", options.seed)
      .word("method", options.method, parse_decode_method)
      .word("unwrap_weights", options.unwrap_weights, parse_unwrap_weights)
      .finish();
  options.validate();
  return options;
}

}  // namespace

void bind_simulate(py::module_& module) {
  module.def("evaluate", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                            const py::object& callback) {
    const EvaluateOptions options = evaluate_options(values);
    return report_dict(without_gil(callback, [&](const Progress& progress) {
      return evaluate(code, camera, options, progress);
    }));
  });
  module.def("best_rotation", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                                 const py::object& callback) {
    const EvaluateOptions options = evaluate_options(values);
    BestRotation best = without_gil(callback, [&](const Progress& progress) {
      return best_rotation(code, camera, options, progress);
    });
    return py::make_tuple(best.rotation_bin, adopt(std::move(best.linear_geometric_mean_m)));
  });
  module.def("robustness", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                              const py::object& callback) {
    const RobustnessOptions options = robustness_options(values);
    return robustness_dict(without_gil(callback, [&](const Progress& progress) {
      return robustness(code, camera, options, progress);
    }));
  });
  module.def("generator_loss", [](const CodeSet& code, const Camera& camera, const py::dict& values,
                                  const py::object& callback) {
    const EvaluateOptions options = evaluate_options(values);
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
