// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/result_document.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "design_setup.hpp"

namespace tofsmith {
namespace {

using nlohmann::json;
using Keys = std::set<std::string>;

Keys keys_of(const json& object) {
  Keys keys;
  for (const auto& [key, ignored] : object.items()) keys.insert(key);
  return keys;
}

const Keys code_keys{"name",        "exposures",     "taps",   "measurements",
                     "samples",     "rotation_bin",  "linear", "circular",
                     "linear_rmse", "circular_rmse", "points"};
const Keys mean_keys{"geometric_mean_m", "geometric_mean_se_m", "mean_m", "mean_se_m"};
const Keys point_keys{"signal_e_per_s",       "ambient_e_per_s",       "linear_mde_m",
                      "linear_se_m",          "circular_mde_m",        "circular_se_m",
                      "linear_rmse_m",        "linear_rmse_se_m",      "circular_rmse_m",
                      "circular_rmse_se_m",   "outlier_rate",          "cramer_rao_mae_m",
                      "receiver_bound_mae_m", "direct_tof_bound_mae_m"};

TEST(EvaluationDocument, HasExactlyTheSpecifiedKeys) {
  const Camera camera = coarse_camera("paper-5f0");
  const EvaluateOptions options{.trials = 1000, .seed = 18446744073709551615ull};
  std::vector<EvaluatedCode> codes{
      {evaluate(build_family("sinusoid-k4", camera), camera, options), 7}};
  codes[0].error.points[0].cramer_rao_mae_m = std::numeric_limits<double>::infinity();
  const json document = json::parse(evaluation_document(camera, codes, options));
  EXPECT_EQ(keys_of(document), (Keys{"tofsmith", "seed", "trials", "outlier_threshold_m", "camera",
                                     "method", "codes"}));
  EXPECT_EQ(document["method"], "zncc");
  EXPECT_EQ(document["seed"], 18446744073709551615ull);
  EXPECT_EQ(document["trials"], 1000);
  EXPECT_EQ(document["camera"]["light"]["peak_factor"], camera.light.peak_factor);
  ASSERT_EQ(document["codes"].size(), 1u);
  const json& code = document["codes"][0];
  EXPECT_EQ(keys_of(code), code_keys);
  EXPECT_EQ(code["name"], "sinusoid-k4");
  EXPECT_EQ(code["exposures"], 4);
  EXPECT_EQ(code["rotation_bin"], 7);
  EXPECT_EQ(keys_of(code["linear"]), mean_keys);
  EXPECT_EQ(keys_of(code["circular"]), mean_keys);
  EXPECT_EQ(keys_of(code["linear_rmse"]), mean_keys);
  EXPECT_EQ(keys_of(code["circular_rmse"]), mean_keys);
  ASSERT_EQ(code["points"].size(), 2u);
  EXPECT_EQ(keys_of(code["points"][0]), point_keys);
  EXPECT_TRUE(code["points"][0]["cramer_rao_mae_m"].is_null()) << "JSON has no infinity";
  EXPECT_EQ(code["points"][1]["linear_mde_m"], codes[0].error.points[1].linear_mde_m.value);
  EXPECT_EQ(code["points"][1]["circular_rmse_se_m"],
            codes[0].error.points[1].circular_rmse_m.standard_error);
  EXPECT_EQ(code["linear_rmse"]["geometric_mean_m"],
            codes[0].error.linear_rmse.geometric_mean_m.value);
}

TEST(EvaluationDocument, MissingBoundsAreNull) {
  Camera camera = coarse_camera("paper-5f0");
  camera.light.impulse_response = camera.sensor.impulse_response = ImpulseResponse();
  const EvaluateOptions options{.trials = 1000};
  const EvaluatedCode code{evaluate(build_family("sinusoid-k4", camera), camera, options)};
  ASSERT_EQ(code.error.points[0].receiver_bound_mae_m, 0.0);
  const json point =
      json::parse(evaluation_document(camera, {&code, 1}, options))["codes"][0]["points"][0];
  EXPECT_TRUE(point["receiver_bound_mae_m"].is_null());
  EXPECT_TRUE(point["direct_tof_bound_mae_m"].is_null());
  EXPECT_TRUE(point["cramer_rao_mae_m"].is_number());
}

TEST(EvaluationDocument, NamesTheDecoder) {
  const EvaluateOptions options{.method = DecodeMethod::unwrap,
                                .unwrap_weights = UnwrapWeights::frequency};
  const json document = json::parse(evaluation_document(coarse_camera("paper-5f0"), {}, options));
  EXPECT_EQ(document["method"], "unwrap");
  EXPECT_EQ(document["unwrap_weights"], "frequency");
}

TEST(EvaluationDocument, ComparesMaximumLikelihoodWithZnccOnTheSameTrials) {
  const Camera camera = coarse_camera("paper-5f0");
  const CodeSet code = build_family("sinusoid-k4", camera);
  EvaluateOptions options{.trials = 1000, .method = DecodeMethod::ml};
  EvaluatedCode evaluated{evaluate(code, camera, options)};
  options.method = DecodeMethod::zncc;
  evaluated.zncc_error = evaluate(code, camera, options);
  options.method = DecodeMethod::ml;
  const json document = json::parse(evaluation_document(camera, {&evaluated, 1}, options));
  EXPECT_EQ(document["method"], "ml");
  Keys expected = code_keys;
  expected.insert("zncc");
  const json& entry = document["codes"][0];
  EXPECT_EQ(keys_of(entry), expected);
  const json& zncc = entry["zncc"];
  EXPECT_EQ(keys_of(zncc), (Keys{"linear", "circular", "linear_rmse", "circular_rmse",
                                 "linear_ratio", "circular_ratio", "points"}));
  EXPECT_EQ(keys_of(zncc["linear"]), mean_keys);
  EXPECT_EQ(zncc["circular"]["geometric_mean_m"],
            evaluated.zncc_error->circular.geometric_mean_m.value);
  ASSERT_EQ(zncc["points"].size(), 2u);
  EXPECT_EQ(
      keys_of(zncc["points"][0]),
      (Keys{"signal_e_per_s", "ambient_e_per_s", "linear_mde_m", "linear_se_m", "circular_mde_m",
            "circular_se_m", "linear_rmse_m", "linear_rmse_se_m", "circular_rmse_m",
            "circular_rmse_se_m", "outlier_rate", "linear_ratio", "circular_ratio"}));
  const json &own = entry["points"][1], &other = zncc["points"][1];
  EXPECT_DOUBLE_EQ(other["circular_ratio"].get<double>() * other["circular_mde_m"].get<double>(),
                   own["circular_mde_m"].get<double>());
}

TEST(EvaluationDocument, IncludesRobustness) {
  const Camera camera = coarse_camera("paper-5f0");
  const CodeSet code = build_family("sinusoid-k4", camera);
  EvaluatedCode evaluated{evaluate(code, camera, {.trials = 200})};
  evaluated.robustness = robustness(code, camera, {.trials = 200});
  const json document = json::parse(evaluation_document(camera, {&evaluated, 1}, {.trials = 200}));
  const json& entry = document["codes"][0]["robustness"];
  EXPECT_EQ(keys_of(entry), (Keys{"error", "trials", "seed", "nominal", "worst_calibrated",
                                  "worst_uncalibrated", "perturbations"}));
  EXPECT_EQ(entry["error"], "linear");
  EXPECT_EQ(entry["nominal"]["ratio"], 1.0);
  ASSERT_EQ(entry["perturbations"].size(), 6u);
  EXPECT_EQ(keys_of(entry["perturbations"][0]), (Keys{"name", "calibrated", "uncalibrated"}));
  EXPECT_EQ(entry["perturbations"][5]["uncalibrated"]["geometric_mean_m"],
            evaluated.robustness->perturbed[5].uncalibrated_m.value);
}

TEST(DesignDocument, AddsTheBestCodeAndComparisons) {
  const Camera camera = coarse_camera("paper-5f0");
  const DesignOptions options = small_options();
  const DesignResult result = design(camera, options);
  const json document = json::parse(design_document(camera, result, options));
  EXPECT_EQ(document["best"], result.winner().code.name());
  ASSERT_EQ(document["codes"].size(), result.candidates.size());
  Keys names;
  for (const json& code : document["codes"]) {
    EXPECT_TRUE(names.insert(code["name"]).second) << "a repeated name";
    Keys expected = code_keys;
    expected.insert({"method", "times_best", "trials"});
    EXPECT_EQ(code["trials"], result.find(code["name"].get<std::string>())->error.trials);
    if (code["name"] == document["best"]) expected.insert("robustness");
    if (code["method"] == "factorize")
      expected.insert({"iterations", "seconds", "per_measurement"});
    EXPECT_EQ(keys_of(code), expected) << code["name"];
  }
  EXPECT_TRUE(names.contains(document["best"]));
  EXPECT_EQ(document["explanation"].size(), 3u);
  const json& designed = document["codes"].back();
  ASSERT_EQ(designed["per_measurement"].size(), 3u);
  for (const char* key : {"residual_rms", "demodulation_duty", "modulation_duty", "peak", "edges"})
    EXPECT_TRUE(designed["per_measurement"][0][key].is_number()) << key;
}

}  // namespace
}  // namespace tofsmith
