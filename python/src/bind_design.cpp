// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reports.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/design/factorize.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith::python {

namespace {

DesignOptions design_options(const py::dict& values, const std::optional<TargetSet>& target) {
  double effort = 1.0;
  DesignOptions options;
  OptionReader(values, "").value("effort", effort);
  options = with_effort(std::move(options), effort);
  OptionReader reader(values, "");
  reader.value("effort", effort).fields(options, {"target"}).finish();
  if (effort == 0.0) options = with_effort(std::move(options), effort);  // whatever the method
  options.target = target;
  options.validate();
  return options;
}

py::dict candidate_dict(const Candidate& candidate, double ranking_error_m) {
  py::dict dict;
  dict["code"] = candidate.code;
  dict["method"] = candidate.method;
  dict["ranking_error_m"] = ranking_error_m;
  dict["error"] = fields_dict(candidate.error);
  dict["rotation_bin"] = candidate.rotation_bin;
  dict["iterations"] = candidate.iterations;
  dict["seconds"] = candidate.seconds;
  dict["target"] = adopt(Eigen::MatrixXd(candidate.target));
  dict["per_measurement"] = object_of(candidate.per_measurement);
  dict["search"] = object_of(candidate.search);
  dict["message"] = candidate.message;
  dict["robustness"] =
      candidate.robustness ? py::object(robustness_dict(*candidate.robustness)) : py::none();
  dict["multipath"] =
      candidate.multipath ? py::object(operating_multipath_dict(*candidate.multipath)) : py::none();
  dict["interference"] = object_of(candidate.interference);
  dict["exposure_order"] = object_of(candidate.exposure_order);
  return dict;
}

/// A finished design with its request, written as by the command line.
struct FinishedDesign {
  Camera camera;
  DesignOptions options;
  DesignResult result;
};

/// Writes the directory of `tofsmith design -o`, with its report.
void write_design(const FinishedDesign& design, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  const DesignDirectory directory(path);
  directory.write(design.camera, design.result, design.options, policy_of(overwrite));
  write_page(directory.path() / "report.html",
             design_report(read_designed_directory(directory.path()), ""), overwrite);
}

void write_design_report(const FinishedDesign& design, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  write_page(path, design_report(design.camera, design.result, std::nullopt, ""), overwrite);
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

/// Requirements with their request, written as by the command line.
struct FoundRequirements {
  Camera camera;
  RequirementOptions options;
  Requirements found;
};

py::dict sufficiency_dict(const Camera& camera, const Sufficiency& s) {
  py::dict dict;
  dict["quantity"] = name_of(s.quantity);
  dict["factor"] = s.factor;
  dict["error_m"] = s.error_m;
  dict["code"] = s.code;
  dict["camera"] =
      s.factor ? py::cast(with_scaled(camera, s.quantity, *s.factor)) : py::object(py::none());
  dict["excluded_below"] = s.excluded_below > 0.0 ? py::cast(s.excluded_below) : py::none();
  return dict;
}

py::dict requirements_dict(const Camera& camera, const py::dict& values,
                           const py::object& callback) {
  RequirementOptions options;
  read_options(values, "", options);
  Requirements found = without_gil(callback, [&](const Progress& progress) {
    return find_requirements(camera, options, progress);
  });
  py::dict dict;
  dict["error_m"] = found.error_m;
  dict["code"] = found.code;
  dict["receiver_bound_mae_m"] = found.bound_m > 0.0 ? py::cast(found.bound_m) : py::none();
  py::list varied;
  for (const Sufficiency& s : found.varied) varied.append(sufficiency_dict(camera, s));
  dict["varied"] = varied;
  dict["map"] = py::none();
  if (found.map) {
    py::dict map;
    map["bandwidth"] = adopt(std::vector<double>(found.map->bandwidth));
    map["power"] = adopt(std::vector<double>(found.map->power));
    map["error_m"] = adopt(Eigen::MatrixXd(found.map->error_m));
    dict["map"] = map;
  }
  dict["_handle"] = FoundRequirements{camera, options, std::move(found)};
  return dict;
}

/// Writes the directory of `tofsmith require -o`, with its page.
void write_found(const FoundRequirements& asked, const std::string& path, bool overwrite) {
  const py::gil_scoped_release release;
  write_requirements(path, asked.camera, asked.found, asked.options, policy_of(overwrite));
  write_page(std::filesystem::path(path) / "report.html",
             requirements_report(asked.camera, asked.found, asked.options, ""), overwrite);
}

py::list atlas_list() {
  py::list entries;
  for (const AtlasEntry& entry : code_atlas()) {
    py::dict dict;
    dict["code"] = entry.code;
    dict["taps"] = entry.of.taps;
    dict["exposures"] = entry.of.exposures;
    dict["peak_factor"] = entry.of.peak_factor;
    dict["bandwidth_f0"] = entry.of.bandwidth_f0;
    dict["shortest_pulse_periods"] = entry.of.shortest_pulse_periods;
    dict["error"] = name_of(entry.of.error);
    dict["linear_m"] = entry.linear_m.value;
    dict["circular_m"] = entry.circular_m.value;
    entries.append(dict);
  }
  return entries;
}

FactorizeOptions factorize_options(const py::dict& values) {
  FactorizeOptions options;
  OptionReader(values, "").value("seed", options.seed).fields(options).finish();
  return options;
}

py::dict candidate_dict(const PairCandidate& candidate) {
  py::dict dict;
  dict["modulation"] = candidate.pair.modulation;
  dict["demodulation"] = candidate.pair.demodulation;
  dict["residual_rms"] = candidate.residual_rms;
  dict["start"] = candidate.start;
  dict["iterations"] = candidate.iterations;
  return dict;
}

py::dict factorize_target(const TargetSet& targets, int measurement, const Camera& camera,
                          const py::dict& values, const py::object& callback) {
  const CorrelationTarget& target = targets.measurements.at(static_cast<std::size_t>(measurement));
  const FactorizeOptions options = factorize_options(values);
  const Factorization found = without_gil(callback, [&](const Progress& progress) {
    return factorize(target, camera, options, progress);
  });
  py::list pairs;
  for (const PairCandidate& candidate : found.candidates) pairs.append(candidate_dict(candidate));
  py::dict dict;
  dict["target"] = adopt(Eigen::VectorXd(target.samples));
  dict["pairs"] = pairs;
  dict["iterations_per_start"] = found.iterations_per_start;
  dict["target_variation_rms"] = found.target_variation_rms;
  dict["message"] = found.message;
  return dict;
}

py::dict alternation_dict(const TargetSet& targets, int measurement, const Camera& camera,
                          int start, double total_variation_weight, const py::dict& values) {
  const CorrelationTarget& target = targets.measurements.at(static_cast<std::size_t>(measurement));
  const FactorizeOptions options = factorize_options(values);
  const Alternation found = [&] {
    const py::gil_scoped_release release;
    return alternate(target, camera, start, total_variation_weight, options);
  }();
  py::dict dict;
  dict["relaxed"] = std::pair(found.relaxed.modulation, found.relaxed.demodulation);
  dict["playable"] = std::pair(found.playable.modulation, found.playable.demodulation);
  add_columns(dict, found.history);
  return dict;
}

py::object generator_reports(const CodeSet& code, const Camera& camera) {
  return object_of(generator_report(code, camera));
}

py::array_t<double> output_of_arm(const Waveform& waveform, const Camera& camera, bool is_light,
                                  int points) {
  const ImpulseResponse& response =
      is_light ? camera.light.impulse_response : camera.sensor.impulse_response;
  return adopt(arm_output(waveform, response, camera.fundamental_frequency_hz, points));
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
  module.def("suggested_exposures", [](const Camera& camera, const std::string& word) {
    return suggested_exposures(camera, parse_word<DesignMethod>("method", word));
  });
  module.def("design", &design_dict);
  module.def("atlas", &atlas_list);
  py::class_<FoundRequirements>(module, "FoundRequirements").def("write", &write_found);
  module.def("find_requirements", &requirements_dict);
  module.def("number_of_targets",
             [](const TargetSet& targets) { return targets.measurements.size(); });
  module.def("factorize", &factorize_target);
  module.def("alternate", &alternation_dict);
  module.def("generator_report", &generator_reports);
  module.def("actual_waveforms", [](const CodeSet& code, const Camera& camera) {
    ActualCode actual = actual_code(code, camera);
    return std::pair(std::move(actual.modulation), std::move(actual.demodulation));
  });
  module.def("arm_output", &output_of_arm);
}

}  // namespace tofsmith::python
