// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/result_document.hpp"

#include <utility>

#include "io/documents/shared/document_text.hpp"
#include "io/text/field_json.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

using Json = nlohmann::ordered_json;

namespace {

Json zncc_json(const DepthErrorReport& report, const DepthErrorReport& zncc) {
  const auto over = [](const Estimate& error, const Estimate& other) {
    return error.value / other.value;
  };
  Json entry = {
      {"linear", fields_json(zncc.linear)},
      {"circular", fields_json(zncc.circular)},
      {"linear_rmse", fields_json(zncc.linear_rmse)},
      {"circular_rmse", fields_json(zncc.circular_rmse)},
      {"linear_ratio", over(report.linear.geometric_mean_m, zncc.linear.geometric_mean_m)},
      {"circular_ratio", over(report.circular.geometric_mean_m, zncc.circular.geometric_mean_m)},
      {"points", Json::array()}};
  for (std::size_t i = 0; i < zncc.points.size(); ++i) {
    const PointDepthError &p = report.points[i], &other = zncc.points[i];
    Json point = fields_json(other, as_bits(FieldMark::apart) | as_bits(FieldMark::bound));
    point["linear_ratio"] = over(p.linear_mde_m, other.linear_mde_m);
    point["circular_ratio"] = over(p.circular_mde_m, other.circular_mde_m);
    entry["points"].push_back(std::move(point));
  }
  return entry;
}

Json robustness_json(const RobustnessReport& report) {
  const auto add_ratio = [&](Json& error_m) {
    error_m["ratio"] = error_m["geometric_mean_m"].get<double>() / report.nominal_m.value;
  };
  Json entry;
  for_each_field(report, [&](const auto& field) {
    write_field(entry, field);
    if (field.name != std::string_view("nominal_m")) return;
    entry["worst_calibrated"] = estimate_json(report.worst_calibrated_m());
    entry["worst_uncalibrated"] = estimate_json(report.worst_uncalibrated_m());
  });
  for (const char* name : {"nominal", "worst_calibrated", "worst_uncalibrated"})
    add_ratio(entry[name]);
  for (Json& perturbed : entry["perturbations"])
    for (const char* name : {"calibrated", "uncalibrated"}) add_ratio(perturbed[name]);
  return entry;
}

/// Returns version, seed, trials, outlier threshold and camera.
Json document_head(const Camera& camera, std::uint64_t seed, std::int64_t trials,
                   double outlier_threshold_m) {
  return {{"tofsmith", TOFSMITH_VERSION},
          {"seed", seed},
          {"trials", trials},
          {"outlier_threshold_m", outlier_threshold_m},
          {"camera", camera_document(camera)}};
}

}  // namespace

Json depth_error_json(const DepthErrorReport& report, int rotation_bin) {
  Json entry;
  for_each_field(report, [&](const auto& field) {
    if (field.is(FieldMark::apart)) return;
    write_field(entry, field);
    if (field.name == std::string_view("samples")) entry["rotation_bin"] = rotation_bin;
  });
  return entry;
}

DepthErrorReport depth_error_from_json(const ValueReader& entry, const ValueReader& document) {
  auto report = fields_from_json<DepthErrorReport>(entry);
  const std::optional<ValueReader> own_trials = entry.optional_member("trials");
  report.trials =
      static_cast<std::int64_t>(own_trials.value_or(document.member("trials")).unsigned_integer());
  report.seed = document.member("seed").unsigned_integer();
  report.outlier_threshold_m = document.member("outlier_threshold_m").number(0.0, infinity, 0.0);
  for (PointDepthError& point : report.points) point.trials = report.trials;
  return report;
}

Json generators_json(const std::vector<GeneratorReport>& reports) {
  Json list = Json::array();
  for (const GeneratorReport& report : reports) list.push_back(fields_json(report));
  return list;
}

Json generator_loss_json(const GeneratorLoss& loss, DepthErrorKind kind) {
  const auto total = [&](const DepthErrorReport& report) -> Json {
    const Estimate& error_m = report.of(kind).geometric_mean_m;
    return {{"value_m", error_m.value}, {"se_m", error_m.standard_error}};
  };
  Json json = {{"error", name_of(kind)},
               {"trials", loss.nominal.trials},
               {"seed", loss.nominal.seed},
               {"nominal", total(loss.nominal)},
               {"actual", total(loss.actual)},
               {"uncalibrated", total(loss.uncalibrated)},
               {"actual_over_nominal", loss.ratio(kind)},
               {"uncalibrated_over_nominal", loss.uncalibrated_ratio(kind)},
               {"correlation_change", loss.correlation_change}};
  const auto error = kind == DepthErrorKind::linear ? &PointDepthError::linear_mde_m
                                                    : &PointDepthError::circular_mde_m;
  for (std::size_t i = 0; i < loss.nominal.points.size(); ++i)
    json["points"].push_back({{"signal_e_per_s", loss.nominal.points[i].point.signal_e_per_s},
                              {"ambient_e_per_s", loss.nominal.points[i].point.ambient_e_per_s},
                              {"nominal_m", (loss.nominal.points[i].*error).value},
                              {"actual_m", (loss.actual.points[i].*error).value},
                              {"uncalibrated_m", (loss.uncalibrated.points[i].*error).value}});
  return json;
}

Json measurements_json(const Candidate& candidate) {
  Json list = Json::array();
  for (const MeasurementReport& m : candidate.per_measurement) {
    list.push_back(fields_json(m));
    if (candidate.target.size() == 0)
      list.back()["residual_rms"] = list.back()["smallest_residual_rms"] = nullptr;
  }
  return list;
}

std::vector<MeasurementReport> measurements_from_json(const ValueReader& entry) {
  std::vector<MeasurementReport> reports;
  if (const auto list = entry.optional_member("per_measurement"))
    for (const ValueReader& m : list->elements())
      reports.push_back(fields_from_json<MeasurementReport>(m));
  return reports;
}

std::string design_document(const Camera& camera, const DesignResult& result,
                            const DesignOptions& options) {
  Json document = document_head(camera, options.seed, options.trials,
                                result.winner().error.outlier_threshold_m);
  document["best"] = result.winner().code.name();
  document["codes"] = Json::array();
  for (const Candidate& candidate : result.candidates) {
    Json entry = depth_error_json(candidate.error, candidate.rotation_bin);
    entry["trials"] = candidate.error.trials;
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
    if (candidate.multipath) entry["multipath"] = fields_json(*candidate.multipath);
    if (candidate.interference) entry["interference"] = fields_json(*candidate.interference);
    if (candidate.exposure_order) entry["exposure_order"] = fields_json(*candidate.exposure_order);
    const Estimate gain = gain_over(result, candidate, camera.operating.measure());
    entry["times_best"] = {{"ratio", gain.value}, {"ratio_se", gain.standard_error}};
    document["codes"].push_back(std::move(entry));
  }
  document["left_out"] = result.left_out;
  document["explanation"] = result.explanation;
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string generators_document(const std::vector<GeneratorReport>& reports) {
  return generators_json(reports).dump();
}

std::string evaluation_document(const Camera& camera, std::span<const EvaluatedCode> codes,
                                const EvaluateOptions& options) {
  Json document = document_head(camera, options.seed, options.trials, options.outlier_threshold_m);
  document["method"] = name_of(options.method);
  if (options.method == DecodeMethod::unwrap)
    document["unwrap_weights"] = name_of(options.unwrap_weights);
  if (options.target_standard_error > 0.0) {
    document["target_standard_error"] = options.target_standard_error;
    document["max_trials"] = options.max_trials;
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
    if (code.motion) entry["motion"] = fields_json(*code.motion);
    if (code.interference) entry["interference"] = fields_json(*code.interference);
    document["codes"].push_back(std::move(entry));
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string requirements_document(const Camera& camera, const Requirements& found,
                                  const RequirementOptions& options) {
  const auto finite_or_null = [](double value) {
    return std::isfinite(value) && value > 0.0 ? Json(value) : Json();
  };
  Json document = {{"tofsmith", TOFSMITH_VERSION}, {"camera", camera_document(camera)}};
  document.update(fields_json(options));
  document["now"] = {{"error_m", found.error_m},
                     {"code", found.code.name()},
                     {"receiver_bound_mae_m", finite_or_null(found.bound_m)}};
  document["varied"] = Json::array();
  for (const Sufficiency& s : found.varied)
    document["varied"].push_back({{"quantity", name_of(s.quantity)},
                                  {"factor", s.factor ? Json(*s.factor) : Json()},
                                  {"error_m", s.error_m},
                                  {"code", s.code.name()},
                                  {"excluded_below", finite_or_null(s.excluded_below)}});
  if (found.map) {
    Json errors = Json::array();
    for (Eigen::Index b = 0; b < found.map->error_m.rows(); ++b)
      errors.push_back(
          std::vector<double>(found.map->error_m.row(b).begin(), found.map->error_m.row(b).end()));
    document["map"] = {
        {"bandwidth", found.map->bandwidth}, {"power", found.map->power}, {"error_m", errors}};
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

namespace {

Json class_json(const DelayClass& its) {
  return {{"from_m", its.from_m},
          {"to_m", its.to_m},
          {"pixels", its.pixels},
          {"ratio", its.ratio},
          {"single_path_bias_m", its.bias_m[0]},
          {"single_path_error_m", its.error_m[0]},
          {"bias_m", its.bias_m[1]},
          {"error_m", its.error_m[1]},
          {"two_share", its.two_share},
          {"unresolved_share", its.unresolved_share}};
}

Json scene_json(const MultipathScene& scene) {
  Json document = {{"scene", scene.name},
                   {"code", scene.code},
                   {"signal_e_per_s", scene.light.signal_e_per_s},
                   {"reference_distance_m", scene.light.reference_distance_m},
                   {"ambient_e_per_s", scene.light.ambient_e_per_s},
                   {"delays", Json::array()},
                   {"all", class_json(scene.all)}};
  for (const DelayClass& its : scene.classes) document["delays"].push_back(class_json(its));
  return document;
}

}  // namespace

std::string multipath_document(const Camera& camera, const std::vector<MultipathErrorReport>& codes,
                               const MultipathErrorOptions& options, const MultipathScene* scene) {
  Json document = {{"version", TOFSMITH_VERSION},
                   {"seed", options.seed},
                   {"trials", options.trials},
                   {"ambient_e_per_s", options.ambient_e_per_s},
                   {"threshold", options.decoding.threshold},
                   {"camera", camera_document(camera)},
                   {"codes", Json::array()}};
  for (const MultipathErrorReport& code : codes) {
    Json entry = {{"code", code.code}, {"measurements", code.measurements}};
    if (!code.why_no_two_returns.empty()) entry["why_no_two_returns"] = code.why_no_two_returns;
    if (!code.why_no_tail.empty()) entry["why_no_tail"] = code.why_no_tail;
    for (const MultipathMaps& maps : code.maps) entry["signals"].push_back(fields_json(maps));
    document["codes"].push_back(std::move(entry));
  }
  if (scene) document["scene"] = scene_json(*scene);
  return document.dump(2);
}

}  // namespace tofsmith
