// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "options.hpp"
#include "output_policy.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/io/correlation_file.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith::python {

namespace {

DesignMethod parse_design_method(const std::string& word) {
  for (const DesignMethod method :
       {DesignMethod::factorize, DesignMethod::optimize, DesignMethod::search, DesignMethod::best})
    if (word == name_of(method)) return method;
  refuse("method", "'" + word + "'", "factorize, optimize, search or best");
}

void read_factorize(const py::dict& values, FactorizeOptions& options) {
  OptionReader(values, "factorize")
      .value("total_variation_weights", options.total_variation_weights)
      .value("max_iterations", options.max_iterations)
      .value("objective_tolerance", options.objective_tolerance)
      .value("feed_back_projection", options.feed_back_projection)
      .value("random_starts", options.random_starts)
      .value("structured_starts", options.structured_starts)
      .value("keep_naive", options.keep_naive)
      .value("refine_edges", options.refine_edges)
      .value("refined", options.refined)
      .value("kept", options.kept)
      .finish();
}

void read_optimize(const py::dict& values, OptimizeOptions& options) {
  OptionReader(values, "optimize")
      .value("samples", options.samples)
      .value("starts", options.starts)
      .value("steps_per_start", options.steps_per_start)
      .value("hops", options.hops)
      .value("steps_per_hop", options.steps_per_hop)
      .value("patience", options.patience)
      .value("refined", options.refined)
      .value("refinement_steps", options.refinement_steps)
      .value("trials_per_step", options.trials_per_step)
      .value("pool_trials", options.pool_trials)
      .value("polish", options.polish)
      .value("polish_steps", options.polish_steps)
      .value("two_return_weight", options.two_return_weight)
      .value("most_two_return_loss", options.most_two_return_loss)
      .finish();
}

void read_search(const py::dict& values, ChipSearchOptions& options) {
  OptionReader(values, "search")
      .value("margin_sigma", options.margin_sigma)
      .value("separation_periods", options.separation_periods)
      .value("equal_duty", options.equal_duty)
      .value("largest_exhaustive", options.largest_exhaustive)
      .value("finalists", options.finalists)
      .value("annealing_starts", options.annealing_starts)
      .value("annealing_steps", options.annealing_steps)
      .finish();
}

DesignOptions design_options(const py::dict& values, const std::optional<TargetSet>& target) {
  DesignOptions options;
  OptionReader reader(values, "");
  reader.word("method", options.method, parse_design_method)
      .value("exposures", options.exposures)
      .value("robust", options.robust)
      .value("baselines", options.baselines)
      .value("best_rotation", options.best_rotation)
      .value("search_trials", options.search_trials)
      .value("trials", options.trials)
      .value("seed", options.seed);
  read_factorize(reader.table("factorize"), options.factorize);
  read_optimize(reader.table("optimize"), options.optimize);
  read_search(reader.table("search"), options.search);
  reader.finish();
  options.target = target;
  options.validate();
  return options;
}

py::dict measurement_dict(const MeasurementReport& report) {
  py::dict dict;
  dict["residual_rms"] = report.residual_rms;
  dict["smallest_residual_rms"] = report.smallest_residual_rms;
  dict["demodulation_duty"] = report.demodulation_duty;
  dict["modulation_duty"] = report.modulation_duty;
  dict["peak"] = report.peak;
  dict["edges"] = report.edges;
  dict["start"] = report.start;
  return dict;
}

py::object search_dict(const std::optional<SearchRecord>& search) {
  if (!search) return py::none();
  py::dict dict;
  std::vector<double> work, error_m;
  for (const SearchStep& step : search->steps) {
    work.push_back(step.work);
    error_m.push_back(step.error_m);
  }
  dict["work_unit"] = search->work_unit;
  dict["error_name"] = search->error_name;
  dict["work"] = adopt(std::move(work));
  dict["error_m"] = adopt(std::move(error_m));
  dict["proved"] = search->proved;
  dict["account"] = search->account;
  return dict;
}

py::dict candidate_dict(const Candidate& candidate, double ranking_error_m) {
  py::dict dict;
  dict["code"] = candidate.code;
  dict["method"] = candidate.method;
  dict["ranking_error_m"] = ranking_error_m;
  dict["error"] = report_dict(candidate.error);
  dict["rotation_bin"] = candidate.rotation_bin;
  dict["iterations"] = candidate.iterations;
  dict["seconds"] = candidate.seconds;
  dict["target"] = adopt(Eigen::MatrixXd(candidate.target));
  py::list measurements;
  for (const MeasurementReport& report : candidate.per_measurement)
    measurements.append(measurement_dict(report));
  dict["per_measurement"] = measurements;
  dict["search"] = search_dict(candidate.search);
  dict["message"] = candidate.message;
  dict["robustness"] =
      candidate.robustness ? py::object(robustness_dict(*candidate.robustness)) : py::none();
  dict["second_returns"] = candidate.second_returns
                               ? py::object(second_return_dict(*candidate.second_returns))
                               : py::none();
  return dict;
}

/// A finished design with what it was asked, to be written as the command writes it.
struct FinishedDesign {
  Camera camera;
  DesignOptions options;
  DesignResult result;
};

/// The directory of `tofsmith design -o`, with its report.
void write_design(const FinishedDesign& design, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  const DesignDirectory directory(path);
  directory.write(design.camera, design.result, design.options, policy_of(overwrite));
  write_file_atomically(directory.path() / "report.html",
                        render(design_report(read_designed_directory(directory.path()), "")),
                        policy_of(overwrite));
}

void write_design_report(const FinishedDesign& design, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  write_file_atomically(path, render(design_report(design.camera, design.result, std::nullopt, "")),
                        policy_of(overwrite));
}

py::dict design_dict(const Camera& camera, const py::dict& values,
                     const std::optional<TargetSet>& target, const py::object& callback) {
  const DesignOptions options = design_options(values, target);
  DesignResult result = without_gil(
      callback, [&](const Progress& progress) { return design(camera, options, progress); });
  py::list candidates;
  for (const Candidate& candidate : result.candidates)
    candidates.append(candidate_dict(candidate, ranking_error_m(candidate, camera, options)));
  py::dict dict;
  dict["candidates"] = candidates;
  dict["best"] = result.best;
  dict["left_out"] = result.left_out;
  dict["explanation"] = result.explanation;
  dict["_handle"] = FinishedDesign{camera, options, std::move(result)};
  return dict;
}

}  // namespace

void bind_design(py::module_& module) {
  py::class_<TargetSet>(module, "TargetSet");
  py::class_<FinishedDesign>(module, "FinishedDesign")
      .def("write", &write_design)
      .def("write_report", &write_design_report);
  module.def("targets_of", &targets_of);
  module.def("load_target", &load_target);
  module.def("targets_from_table",
             [](const std::string& name, const Doubles& table, int samples, bool normalize) {
               return targets_from_table(name, to_matrix(table, "target"), samples, normalize);
             });
  module.def("suggested_exposures", [](const Camera& camera, const std::string& method) {
    return suggested_exposures(camera, parse_design_method(method));
  });
  module.def("design", &design_dict);
}

}  // namespace tofsmith::python
