// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "reports.hpp"

#include <type_traits>

#include "arrays.hpp"

namespace tofsmith::python {

namespace {

py::tuple pair_of(const Estimate& estimate) {
  return py::make_tuple(estimate.value, estimate.standard_error);
}

py::dict mean_dict(const DepthErrorMean& mean) {
  py::dict dict;
  dict["geometric_mean_m"] = mean.geometric_mean_m.value;
  dict["geometric_mean_se_m"] = mean.geometric_mean_m.standard_error;
  dict["mean_m"] = mean.mean_m.value;
  dict["mean_se_m"] = mean.mean_m.standard_error;
  return dict;
}

template <typename OfPoint>
py::array column(const DepthErrorReport& report, OfPoint of_point) {
  std::vector<std::invoke_result_t<OfPoint, const PointDepthError&>> values;
  for (const PointDepthError& point : report.points) values.push_back(of_point(point));
  return adopt(std::move(values));
}

}  // namespace

py::dict report_dict(const DepthErrorReport& report) {
  using Point = PointDepthError;
  py::dict dict;
  dict["code"] = report.code;
  dict["exposures"] = report.exposures;
  dict["taps"] = report.taps;
  dict["measurements"] = report.measurements;
  dict["samples"] = report.samples;
  dict["trials"] = report.trials;
  dict["points_short_of_target"] = report.points_short_of_target;
  dict["seed"] = report.seed;
  dict["outlier_threshold_m"] = report.outlier_threshold_m;
  const auto add = [&](const char* name, auto of_point) { dict[name] = column(report, of_point); };
  add("signal_e_per_s", [](const Point& p) { return p.point.signal_e_per_s; });
  add("ambient_e_per_s", [](const Point& p) { return p.point.ambient_e_per_s; });
  add("point_trials", [](const Point& p) { return p.trials; });
  add("linear_mde_m", [](const Point& p) { return p.linear_mde_m.value; });
  add("linear_se_m", [](const Point& p) { return p.linear_mde_m.standard_error; });
  add("circular_mde_m", [](const Point& p) { return p.circular_mde_m.value; });
  add("circular_se_m", [](const Point& p) { return p.circular_mde_m.standard_error; });
  add("outlier_rate", [](const Point& p) { return p.outlier_rate.value; });
  add("cramer_rao_mae_m", [](const Point& p) { return p.cramer_rao_mae_m; });
  add("receiver_bound_mae_m", [](const Point& p) { return p.receiver_bound_mae_m; });
  add("direct_tof_bound_mae_m", [](const Point& p) { return p.direct_tof_bound_mae_m; });
  dict["linear"] = mean_dict(report.linear);
  dict["circular"] = mean_dict(report.circular);
  return dict;
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
