// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reports.hpp"

#include <pybind11/stl.h>

#include <type_traits>

#include "arrays.hpp"

namespace tofsmith::python {

namespace {

/// Fields of a report into a dict.
class FieldWriter {
 public:
  template <typename Value>
  void value(const char* name, const Value& field) {
    dict[name] = field;
  }
  void mean(const char* name, const DepthErrorMean& field) {
    py::dict of_mean;
    of_mean["geometric_mean_m"] = field.geometric_mean_m.value;
    of_mean["geometric_mean_se_m"] = field.geometric_mean_m.standard_error;
    of_mean["mean_m"] = field.mean_m.value;
    of_mean["mean_se_m"] = field.mean_m.standard_error;
    dict[name] = of_mean;
  }
  template <typename OfPoint>
  void column(const char* name, const std::vector<PointDepthError>& points, OfPoint of_point) {
    using Item = std::remove_cvref_t<std::invoke_result_t<OfPoint, const PointDepthError&>>;
    std::vector<Item> values;
    for (const PointDepthError& point : points) values.push_back(of_point(point));
    dict[name] = adopt(std::move(values));
  }

  py::dict dict;
};

/// The same fields back from a dict.
class FieldReader {
 public:
  explicit FieldReader(const py::dict& values) : values_(values) {}

  template <typename Value>
  void value(const char* name, Value& field) {
    field = py::cast<Value>(values_[name]);
  }
  void mean(const char* name, DepthErrorMean& field) {
    const py::dict of_mean = values_[name];
    const auto number = [&](const char* key) { return py::cast<double>(of_mean[key]); };
    field = {{number("geometric_mean_m"), number("geometric_mean_se_m")},
             {number("mean_m"), number("mean_se_m")}};
  }
  template <typename OfPoint>
  void column(const char* name, std::vector<PointDepthError>& points, OfPoint of_point) {
    using Item = std::remove_cvref_t<std::invoke_result_t<OfPoint, const PointDepthError&>>;
    const auto values = py::cast<std::vector<Item>>(values_[name]);
    if (points.empty()) points.resize(values.size());
    if (values.size() != points.size())
      refuse(name, std::to_string(values.size()) + " values",
             "one for each of " + std::to_string(points.size()) + " operating points");
    for (std::size_t i = 0; i < values.size(); ++i) of_point(points[i]) = values[i];
  }

 private:
  const py::dict& values_;
};

/// Every field of a report by its name.
template <typename Fields, typename Report>
void visit(Fields& fields, Report& report) {
  fields.value("code", report.code);
  fields.value("exposures", report.exposures);
  fields.value("taps", report.taps);
  fields.value("measurements", report.measurements);
  fields.value("samples", report.samples);
  fields.value("trials", report.trials);
  fields.value("points_short_of_target", report.points_short_of_target);
  fields.value("seed", report.seed);
  fields.value("outlier_threshold_m", report.outlier_threshold_m);
  const auto column = [&](const char* name, auto of_point) {
    fields.column(name, report.points, of_point);
  };
  column(
      "signal_e_per_s", [](auto& p) -> auto& { return p.point.signal_e_per_s; });
  column(
      "ambient_e_per_s", [](auto& p) -> auto& { return p.point.ambient_e_per_s; });
  column(
      "point_trials", [](auto& p) -> auto& { return p.trials; });
  column(
      "linear_mde_m", [](auto& p) -> auto& { return p.linear_mde_m.value; });
  column(
      "linear_se_m", [](auto& p) -> auto& { return p.linear_mde_m.standard_error; });
  column(
      "circular_mde_m", [](auto& p) -> auto& { return p.circular_mde_m.value; });
  column(
      "circular_se_m", [](auto& p) -> auto& { return p.circular_mde_m.standard_error; });
  column(
      "outlier_rate", [](auto& p) -> auto& { return p.outlier_rate.value; });
  column(
      "cramer_rao_mae_m", [](auto& p) -> auto& { return p.cramer_rao_mae_m; });
  column(
      "receiver_bound_mae_m", [](auto& p) -> auto& { return p.receiver_bound_mae_m; });
  column(
      "direct_tof_bound_mae_m", [](auto& p) -> auto& { return p.direct_tof_bound_mae_m; });
  fields.mean("linear", report.linear);
  fields.mean("circular", report.circular);
}

}  // namespace

py::tuple pair_of(const Estimate& estimate) {
  return py::make_tuple(estimate.value, estimate.standard_error);
}

py::dict impulse_response_dict(const ImpulseResponse& response) {
  py::dict dict;
  dict["kind"] = std::string(name_of(response.kind));
  if (response.f_max_hz > 0.0) dict["f_max_hz"] = response.f_max_hz;
  if (response.cutoff_hz > 0.0) dict["cutoff_hz"] = response.cutoff_hz;
  if (response.samples.empty()) return dict;
  dict["samples"] = py::tuple(py::cast(response.samples));
  dict["time_step_s"] = response.time_step_s;
  return dict;
}

py::dict report_dict(const DepthErrorReport& report) {
  FieldWriter fields;
  visit(fields, report);
  return fields.dict;
}

DepthErrorReport report_of(const py::dict& values) {
  DepthErrorReport report;
  FieldReader fields(values);
  visit(fields, report);
  return report;
}

py::dict loss_dict(const GeneratorLoss& loss) {
  py::dict dict;
  dict["told"] = report_dict(loss.told);
  dict["played"] = report_dict(loss.played);
  dict["uncalibrated"] = report_dict(loss.uncalibrated);
  dict["correlation_change"] = adopt(std::vector<double>(loss.correlation_change));
  return dict;
}

py::dict robustness_dict(const RobustnessReport& report) {
  py::dict dict;
  dict["kind"] = report.kind == DepthErrorKind::linear ? "linear" : "circular";
  dict["trials"] = report.trials;
  dict["seed"] = report.seed;
  dict["nominal_m"] = pair_of(report.nominal_m);
  dict["worst_calibrated_m"] = pair_of(report.worst_calibrated_m());
  dict["worst_uncalibrated_m"] = pair_of(report.worst_uncalibrated_m());
  py::list names;
  std::vector<double> calibrated_m, uncalibrated_m;
  for (const PerturbedError& perturbed : report.perturbed) {
    names.append(perturbed.name);
    calibrated_m.push_back(perturbed.calibrated_m.value);
    uncalibrated_m.push_back(perturbed.uncalibrated_m.value);
  }
  dict["names"] = names;
  dict["calibrated_m"] = adopt(std::move(calibrated_m));
  dict["uncalibrated_m"] = adopt(std::move(uncalibrated_m));
  return dict;
}

py::dict second_return_dict(const SecondReturnReport& report) {
  py::dict dict;
  dict["single_path_linear_m"] = pair_of(report.single_path.linear_m);
  dict["single_path_circular_m"] = pair_of(report.single_path.circular_m);
  const auto add = [&](const char* name, Estimate SecondReturnError::*mean) {
    dict[name] = report.two_return ? py::object(pair_of((*report.two_return).*mean)) : py::none();
  };
  add("two_return_linear_m", &SecondReturnError::linear_m);
  add("two_return_circular_m", &SecondReturnError::circular_m);
  return dict;
}

}  // namespace tofsmith::python
