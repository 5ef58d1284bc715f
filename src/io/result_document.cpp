// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/result_document.hpp"

#include <limits>
#include <utility>

#include "io/camera_json.hpp"
#include "io/result_json.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

using Json = nlohmann::ordered_json;

namespace {

Json mean_json(const DepthErrorMean& mean) {
  return {{"geometric_mean_m", mean.geometric_mean_m.value},
          {"geometric_mean_se_m", mean.geometric_mean_m.standard_error},
          {"mean_m", mean.mean_m.value},
          {"mean_se_m", mean.mean_m.standard_error}};
}

double not_negative(const JsonReader& json, std::string_view member) {
  return json.member(member).number(0.0, infinity, 0.0);
}

DepthErrorMean mean_from_json(const JsonReader& json) {
  return {{not_negative(json, "geometric_mean_m"), not_negative(json, "geometric_mean_se_m")},
          {not_negative(json, "mean_m"), not_negative(json, "mean_se_m")}};
}

PointDepthError point_from_json(const JsonReader& json) {
  return {
      .point = {not_negative(json, "signal_e_per_s"), not_negative(json, "ambient_e_per_s")},
      .linear_mde_m = {not_negative(json, "linear_mde_m"), not_negative(json, "linear_se_m")},
      .circular_mde_m = {not_negative(json, "circular_mde_m"), not_negative(json, "circular_se_m")},
      .outlier_rate = {json.member("outlier_rate").number(0.0, 1.0, 0.0), 0.0},
      .cramer_rao_mae_m = json.member("cramer_rao_mae_m").number_or_infinity(),
      .receiver_bound_mae_m = json.member("receiver_bound_mae_m").number_or_infinity(),
      .direct_tof_bound_mae_m = json.member("direct_tof_bound_mae_m").number_or_infinity()};
}

/// What every list of points says of one.
Json point_json(const PointDepthError& p) {
  return {{"signal_e_per_s", p.point.signal_e_per_s},
          {"ambient_e_per_s", p.point.ambient_e_per_s},
          {"linear_mde_m", p.linear_mde_m.value},
          {"linear_se_m", p.linear_mde_m.standard_error},
          {"circular_mde_m", p.circular_mde_m.value},
          {"circular_se_m", p.circular_mde_m.standard_error},
          {"outlier_rate", p.outlier_rate.value}};
}

/// What `report` is compared with, and how many times as large its errors are.
Json zncc_json(const DepthErrorReport& report, const DepthErrorReport& zncc) {
  const auto over = [](const Estimate& error, const Estimate& other) {
    return error.value / other.value;
  };
  Json entry = {
      {"linear", mean_json(zncc.linear)},
      {"circular", mean_json(zncc.circular)},
      {"linear_ratio", over(report.linear.geometric_mean_m, zncc.linear.geometric_mean_m)},
      {"circular_ratio", over(report.circular.geometric_mean_m, zncc.circular.geometric_mean_m)},
      {"points", Json::array()}};
  for (std::size_t i = 0; i < zncc.points.size(); ++i) {
    const PointDepthError &p = report.points[i], &other = zncc.points[i];
    Json point = point_json(other);
    point["linear_ratio"] = over(p.linear_mde_m, other.linear_mde_m);
    point["circular_ratio"] = over(p.circular_mde_m, other.circular_mde_m);
    entry["points"].push_back(std::move(point));
  }
  return entry;
}

}  // namespace

Json depth_error_json(const DepthErrorReport& report, int rotation_bin) {
  Json entry = {{"name", report.code},
                {"exposures", report.exposures},
                {"taps", report.taps},
                {"measurements", report.measurements},
                {"samples", report.samples},
                {"rotation_bin", rotation_bin},
                {"linear", mean_json(report.linear)},
                {"circular", mean_json(report.circular)},
                {"points", Json::array()}};
  for (const PointDepthError& p : report.points) {
    Json point = point_json(p);
    point["cramer_rao_mae_m"] = p.cramer_rao_mae_m;
    point["receiver_bound_mae_m"] = p.receiver_bound_mae_m;
    point["direct_tof_bound_mae_m"] = p.direct_tof_bound_mae_m;
    entry["points"].push_back(std::move(point));
  }
  return entry;
}

DepthErrorReport depth_error_from_json(const JsonReader& entry, const JsonReader& document) {
  constexpr int any = std::numeric_limits<int>::max();
  DepthErrorReport report;
  report.code = entry.member("name").text();
  report.exposures = entry.member("exposures").integer(1, any);
  report.taps = entry.member("taps").integer(1, any);
  report.measurements = entry.member("measurements").integer(1, any);
  report.samples = entry.member("samples").integer(1, any);
  report.trials = static_cast<std::int64_t>(document.member("trials").unsigned_integer());
  report.seed = document.member("seed").unsigned_integer();
  report.outlier_threshold_m = not_negative(document, "outlier_threshold_m");
  report.linear = mean_from_json(entry.member("linear"));
  report.circular = mean_from_json(entry.member("circular"));
  for (const JsonReader& point : entry.member("points").elements())
    report.points.push_back(point_from_json(point));
  for (PointDepthError& point : report.points) point.trials = report.trials;
  return report;
}

Json robustness_json(const RobustnessReport& report) {
  const double nominal_m = report.nominal_m.value;
  const auto error = [&](const Estimate& error_m) -> Json {
    return {{"geometric_mean_m", error_m.value},
            {"geometric_mean_se_m", error_m.standard_error},
            {"ratio", error_m.value / nominal_m}};
  };
  Json entry = {{"error", report.kind == DepthErrorKind::linear ? "linear" : "circular"},
                {"trials", report.trials},
                {"seed", report.seed},
                {"nominal", error(report.nominal_m)},
                {"worst_calibrated", error(report.worst_calibrated_m())},
                {"worst_uncalibrated", error(report.worst_uncalibrated_m())},
                {"perturbations", Json::array()}};
  for (const PerturbedError& p : report.perturbed)
    entry["perturbations"].push_back({{"name", p.name},
                                      {"calibrated", error(p.calibrated_m)},
                                      {"uncalibrated", error(p.uncalibrated_m)}});
  return entry;
}

RobustnessReport robustness_from_json(const JsonReader& json) {
  const auto error = [](const JsonReader& entry) -> Estimate {
    return {not_negative(entry, "geometric_mean_m"), not_negative(entry, "geometric_mean_se_m")};
  };
  RobustnessReport report{
      .kind = json.member("error").text() == "linear" ? DepthErrorKind::linear
                                                      : DepthErrorKind::circular,
      .trials = static_cast<std::int64_t>(json.member("trials").unsigned_integer()),
      .seed = json.member("seed").unsigned_integer(),
      .nominal_m = error(json.member("nominal"))};
  for (const JsonReader& p : json.member("perturbations").elements())
    report.perturbed.push_back(
        {p.member("name").text(), error(p.member("calibrated")), error(p.member("uncalibrated"))});
  return report;
}

Json second_returns_json(const SecondReturnReport& report) {
  const auto error = [](const SecondReturnError& its) -> Json {
    return {{"linear_m", its.linear_m.value},
            {"linear_se_m", its.linear_m.standard_error},
            {"circular_m", its.circular_m.value},
            {"circular_se_m", its.circular_m.standard_error}};
  };
  return {{"single_path", error(report.single_path)},
          {"two_return", report.two_return ? error(*report.two_return) : Json()}};
}

SecondReturnReport second_returns_from_json(const JsonReader& json) {
  const auto error = [](const JsonReader& its) -> SecondReturnError {
    return {{not_negative(its, "linear_m"), not_negative(its, "linear_se_m")},
            {not_negative(its, "circular_m"), not_negative(its, "circular_se_m")}};
  };
  SecondReturnReport report{.single_path = error(json.member("single_path"))};
  const JsonReader two_return = json.member("two_return");
  if (!two_return.is_null()) report.two_return = error(two_return);
  return report;
}

Json measurements_json(const Candidate& candidate) {
  Json list = Json::array();
  for (const MeasurementReport& m : candidate.per_measurement) {
    Json entry = {{"residual_rms", nullptr}, {"smallest_residual_rms", nullptr}};
    if (candidate.target.size() > 0)
      entry = {{"residual_rms", m.residual_rms},
               {"smallest_residual_rms", m.smallest_residual_rms}};
    entry.update({{"demodulation_duty", m.demodulation_duty},
                  {"modulation_duty", m.modulation_duty},
                  {"peak", m.peak},
                  {"edges", m.edges},
                  {"start", m.start}});
    list.push_back(std::move(entry));
  }
  return list;
}

std::vector<MeasurementReport> measurements_from_json(const JsonReader& entry) {
  std::vector<MeasurementReport> reports;
  const auto list = entry.optional_member("per_measurement");
  if (!list) return reports;
  for (const JsonReader& m : list->elements()) {
    MeasurementReport report{.demodulation_duty = m.member("demodulation_duty").number(),
                             .modulation_duty = m.member("modulation_duty").number(),
                             .peak = m.member("peak").number(),
                             .edges = m.member("edges").integer(0, std::numeric_limits<int>::max()),
                             .start = m.member("start").text()};
    if (!m.member("residual_rms").is_null()) {
      report.residual_rms = not_negative(m, "residual_rms");
      report.smallest_residual_rms = not_negative(m, "smallest_residual_rms");
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

Json document_head(const Camera& camera, std::uint64_t seed, std::int64_t trials,
                   double outlier_threshold_m) {
  return {{"tofsmith", TOFSMITH_VERSION},
          {"seed", seed},
          {"trials", trials},
          {"outlier_threshold_m", outlier_threshold_m},
          {"camera", camera_document(camera)}};
}

Json design_json(const Camera& camera, const DesignResult& result, const DesignOptions& options) {
  Json document = document_head(camera, options.seed, options.trials,
                                result.winner().error.outlier_threshold_m);
  document["best"] = result.winner().code.name();
  document["codes"] = Json::array();
  for (const Candidate& candidate : result.candidates) {
    Json entry = depth_error_json(candidate.error, candidate.rotation_bin);
    entry["method"] = candidate.method;
    if (candidate.is_designed()) {
      entry["iterations"] = candidate.iterations;
      entry["seconds"] = candidate.seconds;
      entry["per_measurement"] = measurements_json(candidate);
    }
    if (candidate.search) {
      entry["proved"] = candidate.search->proved;
      entry["account"] = candidate.search->account;
    }
    if (candidate.robustness) entry["robustness"] = robustness_json(*candidate.robustness);
    if (candidate.second_returns)
      entry["second_returns"] = second_returns_json(*candidate.second_returns);
    const Estimate gain = gain_over(result, candidate, camera.operating.error);
    entry["times_best"] = {{"ratio", gain.value}, {"ratio_se", gain.standard_error}};
    document["codes"].push_back(std::move(entry));
  }
  document["left_out"] = result.left_out;
  document["explanation"] = result.explanation;
  return document;
}

std::string evaluation_document(const Camera& camera, std::span<const EvaluatedCode> codes,
                                const EvaluateOptions& options) {
  Json document = document_head(camera, options.seed, options.trials, options.outlier_threshold_m);
  document["method"] = name_of(options.method);
  if (options.method == DecodeMethod::unwrap)
    document["unwrap_weights"] = name_of(options.unwrap_weights);
  if (options.target_standard_error > 0.0) {
    document["target_standard_error"] = options.target_standard_error;
    document["most_trials"] = options.most_trials;
  }
  document["codes"] = Json::array();
  for (const EvaluatedCode& code : codes) {
    Json entry = depth_error_json(code.error, code.rotation_bin);
    if (options.target_standard_error > 0.0) {
      entry["points_short_of_target"] = code.error.points_short_of_target;
      for (std::size_t p = 0; p < code.error.points.size(); ++p)
        entry["points"][p]["trials"] = code.error.points[p].trials;
    }
    if (code.zncc_error) entry["zncc"] = zncc_json(code.error, *code.zncc_error);
    if (code.robustness) entry["robustness"] = robustness_json(*code.robustness);
    document["codes"].push_back(std::move(entry));
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string design_document(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options) {
  return design_json(camera, result, options).dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tofsmith
