// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "bindings.hpp"
#include "field_dicts.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "tofsmith/camera/generator_report.hpp"
#include "tofsmith/design/factorize.hpp"

namespace tofsmith::python {

namespace {

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

py::list generator_reports(const CodeSet& code, const Camera& camera) {
  py::list list;
  for (const GeneratorReport& report : generator_report(code, camera))
    list.append(fields_dict(report));
  return list;
}

py::array_t<double> output_of_arm(const Waveform& waveform, const Camera& camera, bool is_light,
                                  int points) {
  const ImpulseResponse& response =
      is_light ? camera.light.impulse_response : camera.sensor.impulse_response;
  return adopt(arm_output(waveform, response, camera.fundamental_frequency_hz, points));
}

}  // namespace

void bind_factorize(py::module_& module) {
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
