// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/result_document.hpp"

#include "io/camera_json.hpp"
#include "io/result_json.hpp"
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

DepthErrorMean mean_from_json(const nlohmann::json& json) {
  return {{json.at("geometric_mean_m"), json.at("geometric_mean_se_m")},
          {json.at("mean_m"), json.at("mean_se_m")}};
}

/// JSON has no infinity: a bound that does not exist is null.
double number_or_infinity(const nlohmann::json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
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
  for (const PointDepthError& p : report.points)
    entry["points"].push_back({{"signal_e_per_s", p.point.signal_e_per_s},
                               {"ambient_e_per_s", p.point.ambient_e_per_s},
                               {"linear_mde_m", p.linear_mde_m.value},
                               {"linear_se_m", p.linear_mde_m.standard_error},
                               {"circular_mde_m", p.circular_mde_m.value},
                               {"circular_se_m", p.circular_mde_m.standard_error},
                               {"outlier_rate", p.outlier_rate.value},
                               {"cramer_rao_mae_m", p.cramer_rao_mae_m},
                               {"receiver_bound_mae_m", p.receiver_bound_mae_m}});
  return entry;
}

DepthErrorReport depth_error_from_json(const nlohmann::json& entry,
                                       const nlohmann::json& document) {
  DepthErrorReport report;
  report.code = entry.at("name");
  report.exposures = entry.at("exposures");
  report.taps = entry.at("taps");
  report.measurements = entry.at("measurements");
  report.samples = entry.at("samples");
  report.trials = document.at("trials");
  report.seed = document.at("seed");
  report.outlier_threshold_m = document.at("outlier_threshold_m");
  report.linear = mean_from_json(entry.at("linear"));
  report.circular = mean_from_json(entry.at("circular"));
  for (const auto& p : entry.at("points"))
    report.points.push_back(
        {.point = {p.at("signal_e_per_s"), p.at("ambient_e_per_s")},
         .linear_mde_m = {p.at("linear_mde_m"), p.at("linear_se_m")},
         .circular_mde_m = {p.at("circular_mde_m"), p.at("circular_se_m")},
         .outlier_rate = {p.at("outlier_rate"), 0.0},
         .cramer_rao_mae_m = number_or_infinity(p.at("cramer_rao_mae_m")),
         .receiver_bound_mae_m = number_or_infinity(p.at("receiver_bound_mae_m"))});
  return report;
}

Json measurements_json(const std::vector<MeasurementReport>& reports) {
  Json list = Json::array();
  for (const MeasurementReport& m : reports)
    list.push_back({{"residual_rms", m.residual_rms},
                    {"demodulation_duty", m.demodulation_duty},
                    {"modulation_duty", m.modulation_duty},
                    {"peak", m.peak},
                    {"edges", m.edges},
                    {"start", m.start}});
  return list;
}

std::vector<MeasurementReport> measurements_from_json(const nlohmann::json& entry) {
  std::vector<MeasurementReport> reports;
  if (!entry.contains("per_measurement")) return reports;
  for (const auto& m : entry.at("per_measurement"))
    reports.push_back({.residual_rms = m.at("residual_rms"),
                       .demodulation_duty = m.at("demodulation_duty"),
                       .modulation_duty = m.at("modulation_duty"),
                       .peak = m.at("peak"),
                       .edges = m.at("edges"),
                       .start = m.at("start")});
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
    if (!candidate.per_measurement.empty()) {
      entry["iterations"] = candidate.iterations;
      entry["seconds"] = candidate.seconds;
      entry["per_measurement"] = measurements_json(candidate.per_measurement);
    }
    document["codes"].push_back(std::move(entry));
  }
  document["left_out"] = result.left_out;
  return document;
}

std::string evaluation_document(const Camera& camera, std::span<const EvaluatedCode> codes,
                                const EvaluateOptions& options) {
  Json document = document_head(camera, options.seed, options.trials, options.outlier_threshold_m);
  document["codes"] = Json::array();
  for (const EvaluatedCode& code : codes)
    document["codes"].push_back(depth_error_json(code.error, code.rotation_bin));
  return document.dump(2);
}

std::string design_document(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options) {
  return design_json(camera, result, options).dump(2);
}

}  // namespace tofsmith
