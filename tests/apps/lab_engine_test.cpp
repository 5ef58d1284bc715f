// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
// The engine of the lab page gives the same answers as the library and the command line.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "answer.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::lab {
namespace {

struct Answered {
  Json json;
  std::vector<NamedArray> arrays;

  template <typename Number>
  const std::vector<Number>& array(std::string_view name) const {
    for (const NamedArray& array : arrays)
      if (array.name == name) return std::get<std::vector<Number>>(array.values);
    throw std::runtime_error("no array " + std::string(name));
  }
};

Answered ask(const Json& request) {
  Reply reply = answer(request.dump());
  const Json json = Json::parse(reply.json);
  EXPECT_FALSE(json.contains("error")) << reply.json.substr(0, 500);
  return {json.value("answer", Json::object()), std::move(reply.arrays)};
}

Json error_of(std::string_view request) {
  const Json json = Json::parse(answer(request).json);
  EXPECT_FALSE(json.contains("answer")) << request;
  return json.value("error", Json::object());
}

Json field_of(const Answered& answered, std::string_view key) {
  for (const Json& field : answered.json["fields"])
    if (field["key"] == key) return field;
  return nullptr;
}

TEST(LabEngine, EvaluateReturnsTheDocumentOfTheCommand) {
  const Camera camera = load_camera("paper-10f0", std::array{std::string("samples=120")});
  const Answered answered = ask({{"call", "evaluate"},
                                 {"camera", camera_to_toml(camera)},
                                 {"code", {{"name", "hamiltonian-k4"}}},
                                 {"trials", 200},
                                 {"seed", 7}});
  EvaluateOptions options;
  options.trials = 200;
  options.seed = 7;
  const EvaluatedCode code{
      evaluate(load_code("hamiltonian-k4", camera), camera, options), 0, {}, {}};
  EXPECT_EQ(answered.json["document"],
            Json::parse(evaluation_document(camera, std::array{code}, options)));
  EXPECT_EQ(answered.json["error_m"]["shape"], Json({5, 5}));
  const std::vector<double>& error_m = answered.array<double>("error_m");
  for (std::size_t i = 0; i < error_m.size(); ++i)
    EXPECT_EQ(error_m[i], code.error.points[i].linear_mde_m.value);
}

TEST(LabEngine, ACameraIsReadBackAndEveryKeyIsExplained) {
  for (const std::string& name : built_in_camera_names()) {
    const Answered answered = ask({{"call", "camera"}, {"built_in", name}});
    EXPECT_EQ(parse_camera_toml(answered.json["toml"].get<std::string>(), "x.toml"),
              built_in_camera(name));
    for (const Json& field : answered.json["fields"])
      if (!field["value"].is_null() && field["key"] != "name") {
        EXPECT_FALSE(field["doc"].get<std::string>().empty()) << field["key"];
      }
  }
}

TEST(LabEngine, AFieldHasTypeUnitAndBounds) {
  const Answered answered = ask({{"call", "camera"}, {"built_in", "paper-10f0"}});
  const Json peak = field_of(answered, "light.peak_factor");
  EXPECT_EQ(peak["type"], "number");
  EXPECT_EQ(peak["section"], "light");
  EXPECT_EQ(peak["value"], 15);
  EXPECT_EQ(peak["low"], 1);
  const Json bits = field_of(answered, "light.generator.table_points");
  EXPECT_EQ(bits["low"], 2);
  EXPECT_EQ(bits["high"], 1 << 20);
  EXPECT_TRUE(bits["value"].is_null());
  EXPECT_EQ(field_of(answered, "sensor.dark_current_e_per_s")["unit"], "e/s");
  EXPECT_EQ(field_of(answered, "operating.error")["choices"], Json({"linear", "circular"}));
  EXPECT_TRUE(field_of(answered, "light.impulse_response.cutoff_hz").is_null());  // kind is hann
}

TEST(LabEngine, SetEqualsTheCommandLineOption) {
  const Answered answered = ask(
      {{"call", "set"}, {"built_in", "paper-10f0"}, {"key", "light.peak_factor"}, {"value", "7"}});
  EXPECT_EQ(parse_camera_toml(answered.json["toml"].get<std::string>(), "x.toml"),
            load_camera("paper-10f0", std::array{std::string("light.peak_factor=7")}));
}

TEST(LabEngine, DepthsAreListsAndAreKeptWhenOtherFieldsChange) {
  const std::array settings = {std::string("operating.working_distance_m=[1, 3]"),
                               std::string("operating.depths=[3, 1, 0.5]")};
  const Camera camera = load_camera("paper-10f0", settings);
  const Answered answered = ask({{"call", "set"},
                                 {"camera", camera_to_toml(camera)},
                                 {"key", "operating.error"},
                                 {"value", "circular"}});
  const Camera changed = parse_camera_toml(answered.json["toml"].get<std::string>(), "x.toml");
  EXPECT_EQ(changed.operating.error, DepthErrorKind::circular);
  EXPECT_EQ(changed.operating.depths, camera.operating.depths);
  const Json depths = field_of(answered, "operating.depths");
  EXPECT_EQ(depths["type"], "list");
  EXPECT_EQ(depths["value"], Json({3, 1, 0.5}));
  EXPECT_EQ(depths["low"], 0);
  EXPECT_FALSE(depths.contains("high"));
  const Json distance = field_of(answered, "operating.working_distance_m");
  EXPECT_EQ(distance["unit"], "m");
  EXPECT_EQ(distance["value"], Json({1, 3}));
  EXPECT_FALSE(distance["doc"].get<std::string>().empty());
}

TEST(LabEngine, ChangingTheKindOfResponseSetsItsParameter) {
  for (const char* kind : {"none", "hann", "gaussian", "lowpass"}) {
    const Answered answered = ask({{"call", "set"},
                                   {"built_in", "paper-10f0"},
                                   {"key", "light.impulse_response.kind"},
                                   {"value", kind}});
    const Json& change = answered.json["change"];
    const std::string setting =
        change["key"].get<std::string>() + "=" + change["value"].get<std::string>();
    const Camera camera = load_camera("paper-10f0", std::array{setting});
    EXPECT_EQ(name_of(camera.light.impulse_response.kind), kind);
    EXPECT_EQ(answered.json["toml"], camera_to_toml(camera));
  }
}

TEST(LabEngine, AKeyWithoutValueIsRemoved) {
  const Answered answered = ask({{"call", "camera"},
                                 {"built_in", "paper-10f0"},
                                 {"changes",
                                  {{{"key", "sensor.full_well_e"}, {"value", "3e4"}},
                                   {{"key", "sensor.full_well_e"}, {"value", nullptr}}}}});
  EXPECT_EQ(parse_camera_toml(answered.json["toml"].get<std::string>(), "x.toml"),
            built_in_camera("paper-10f0"));
}

TEST(LabEngine, AnEmptyValueIsRejectedAtItsKey) {
  EXPECT_EQ(error_of(R"({"call": "camera", "built_in": "paper-10f0",
                        "changes": [{"key": "light.peak_factor", "value": " "}]})")["field"],
            "light.peak_factor");
}

TEST(LabEngine, ASavedCodeIsReadBack) {
  const Json camera = {{"built_in", "paper-10f0"}};
  Json request = {
      {"call", "save_code"}, {"built_in", "paper-10f0"}, {"code", {{"name", "hamiltonian-k5"}}}};
  const Answered saved = ask(request);
  request["call"] = "code";
  const Answered by_name = ask(request);
  request["code"] = {{"file", saved.json["file"]}};
  const Answered by_file = ask(request);
  EXPECT_EQ(by_name.json, by_file.json);
  EXPECT_EQ(by_name.array<double>("correlation"), by_file.array<double>("correlation"));
  EXPECT_EQ(by_name.json["correlation"]["shape"], Json({5, 240}));
  EXPECT_EQ(by_name.json["curve"]["shape"], Json({240, 3}));
}

Json move_request(const char* arm, int edge, double position) {
  return {{"call", "move_edge"}, {"built_in", "paper-30x"}, {"code", {{"name", "square-k4"}}},
          {"arm", arm},          {"measurement", 1},        {"edge", edge},
          {"position", position}};
}

TEST(LabEngine, AMovedEdgeStopsAtItsNeighbour) {
  const Answered before =
      ask({{"call", "code"}, {"built_in", "paper-30x"}, {"code", {{"name", "square-k4"}}}});
  const std::vector<double> was = before.json["gate_edges"][1];
  ASSERT_EQ(was.size(), 2u);
  const Answered moved = ask(move_request("gate", 1, was[1] - 0.1));
  const std::vector<double> is = moved.json["gate_edges"][1];
  EXPECT_NEAR(is[0], was[0], 1e-12);
  EXPECT_NEAR(is[1], was[1] - 0.1, 1e-12);
  EXPECT_EQ(moved.json["gate_edges"][0], before.json["gate_edges"][0]);
  EXPECT_EQ(moved.json["light_edges"], before.json["light_edges"]);

  const Answered stopped = ask(move_request("gate", 1, was[0] + 1e-9));
  const std::vector<double> shut = stopped.json["gate_edges"][1];
  EXPECT_GT(std::fmod(shut[1] - shut[0] + 1.0, 1.0), 0.0);
}

TEST(LabEngine, AMovedEdgeOfLightKeepsThePowerAndThePeakLimit) {
  for (const double position : {0.01, 0.2, 0.9}) {
    const Answered moved = ask(move_request("light", 1, position));
    const CodeSet code = parse_code_json(moved.json["file"].get<std::string>());
    EXPECT_LE(code.modulation(1).mean(), 1.0 + 1e-12);
    EXPECT_LE(code.peak(), 30.0 * (1 + 1e-12));
  }
}

TEST(LabEngine, TheComplementOfAGateIsPreserved) {
  Json request = move_request("gate", 0, 0.13);
  request["changes"] = {{{"key", "sensor.taps"}, {"value", "2"}},
                        {{"key", "sensor.drain"}, {"value", "false"}}};
  const CodeSet code = parse_code_json(ask(request).json["file"].get<std::string>());
  ASSERT_EQ(code.taps(), 2);
  EXPECT_NEAR(code.demodulation(0).mean() + code.demodulation(1).mean(), 1.0, 1e-12);
}

TEST(LabEngine, ASceneIsDecodedAndFilteringReducesErrors) {
  Json request = {{"call", "scene"},
                  {"built_in", "paper-10f0"},
                  {"scene", "ball"},
                  {"width", 48},
                  {"code", {{"name", "hamiltonian-k4"}}},
                  {"seed", 3}};
  const Answered plain = ask(request);
  EXPECT_EQ(plain.json["depth_m"]["shape"], Json({36, 48}));
  EXPECT_EQ(plain.array<float>("depth_m").size(), 36u * 48u);
  request["filter"] = "light";
  EXPECT_LT(ask(request).json["mean_error_m"], plain.json["mean_error_m"]);
}

TEST(LabEngine, CommandsCanBePastedIntoAShell) {
  const Answered answered =
      ask({{"call", "command"},
           {"what", "evaluate"},
           {"built_in", "paper-10f0"},
           {"codes", {"hamiltonian-k4", "it's.code.json"}},
           {"trials", 1000},
           {"seed", nullptr},
           {"changes", {{{"key", "operating.signal_e_per_s"}, {"value", "[1e3, 1e4]"}}}}});
  EXPECT_EQ(answered.json["command"],
            "tofsmith evaluate hamiltonian-k4 'it'\\''s.code.json' --camera paper-10f0 "
            "--set 'operating.signal_e_per_s=[1e3, 1e4]' --trials 1000");
}

TEST(LabEngine, CommandsOmitKeysThatThePageOmits) {
  const Answered answered =
      ask({{"call", "command"},
           {"what", "camera"},
           {"built_in", "kinect-v2"},
           {"changes", {{{"key", "sensor.full_well_e"}, {"value", nullptr}}}}});
  EXPECT_EQ(answered.json["command"], "tofsmith cameras kinect-v2 --set sensor.full_well_e=");
}

TEST(LabEngine, ADesignReturnsACodeForTheCameraAndReportsProgress) {
  double reported = 0.0;
  const Json request = {{"call", "design"},
                        {"built_in", "paper-10f0"},
                        {"method", "factorize"},
                        {"exposures", 3},
                        {"effort", 0.01},
                        {"trials", 1000},
                        {"changes",
                         {{{"key", "samples"}, {"value", "60"}},
                          {{"key", "operating.signal_e_per_s"}, {"value", "[1e5]"}},
                          {{"key", "operating.ambient_e_per_s"}, {"value", "[1e2]"}}}}};
  const Json json = Json::parse(answer(request.dump(), [&](double fraction, std::string_view) {
                                  reported = fraction;
                                  return true;
                                }).json);
  ASSERT_TRUE(json.contains("answer")) << json;
  EXPECT_EQ(reported, 1.0);
  const CodeSet code = parse_code_json(json["answer"]["file"].get<std::string>());
  EXPECT_EQ(code.name(), json["answer"]["document"]["best"].get<std::string>());
  EXPECT_GT(json["answer"]["error_m"], 0.0);
}

TEST(LabEngine, EveryRequestGetsAReply) {
  const std::string deep(100000, '[');
  std::string dotted = "a";
  for (int i = 0; i < 100000; ++i) dotted += ".a";
  const std::string code_of = R"("built_in": "paper-10f0", "code": )";
  const std::vector<std::string> requests = {
      "",
      "null",
      "[]",
      deep,
      "{\"call\": \"\xff\xfe\"}",
      R"({"call": 3})",
      R"({"call": "camera"})",
      R"({"call": "camera", "camera": 5})",
      R"({"call": "camera", "camera": "fundamental_frequency_hz = nan"})",
      R"({"call": "camera", "camera": "fundamental_frequency_hz = 15e6\nsamples = 99999999"})",
      R"({"call": "camera", "camera": ")" + std::string(5000, '[') + "\"}",
      R"({"call": "camera", "camera": ")" + dotted + R"( = 1"})",
      R"({"call": "camera", "built_in": "no-such-camera"})",
      R"({"call": "camera", "built_in": "../../etc/passwd"})",
      R"({"call": "set", "built_in": "paper-10f0", "key": "light.peak_factor", "value": "nan"})",
      R"({"call": "set", "built_in": "paper-10f0", "key": "lite", "value": "1"})",
      R"({"call": "set", "built_in": "paper-10f0", "key": "", "value": ""})",
      R"({"call": "set", "built_in": "paper-10f0", "key": "light.impulse_response.kind", "value": "file"})",
      R"({"call": "camera", "built_in": "paper-10f0", "changes": [{"key": 1}]})",
      R"({"call": "code", )" + code_of + R"(null})",
      R"({"call": "code", )" + code_of + R"({"name": "hamiltonian-k99"}})",
      R"({"call": "code", )" + code_of + R"({"file": "{\"format\": 1}"}})",
      R"({"call": "code", )" + code_of + R"({"file": ")" + std::string(1000, '[') + R"("}})",
      R"({"call": "evaluate", "trials": 1, )" + code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "evaluate", "trials": 1e400, )" + code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "evaluate", "seed": -1, )" + code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "scene", "width": 1e9, )" + code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "scene", "scene": "nowhere", )" + code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "scene", "signal": -1, )" + code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "move_edge", "arm": "gate", "measurement": 0, "edge": 99, "position": 0, )" +
          code_of + R"({"name": "square-k4"}})",
      R"({"call": "move_edge", "arm": "light", "measurement": 0, "edge": 0, "position": 0, )" +
          code_of + R"({"name": "sinusoid-k4"}})",
      R"({"call": "design", "effort": 1e9, "built_in": "paper-10f0"})",
      R"({"call": "command", "what": "rm"})",
  };
  for (const std::string& request : requests)
    EXPECT_FALSE(error_of(request).value("message", "").empty()) << request.substr(0, 200);
  EXPECT_FALSE(error_of(std::string(std::size_t{33} << 20, ' ')).empty());
}

TEST(LabEngine, WrongArgumentsAreReportedAsInFiles) {
  const auto error = [](const std::string& arguments) {
    return error_of(R"({"call": "evaluate", "built_in": "paper-10f0",
                        "code": {"name": "sinusoid-k4"}, )" +
                    arguments + "}");
  };
  EXPECT_EQ(error(R"("trials": "many")")["message"],
            "request: /trials: found \"many\"; expected an integer in [0, 2^64)");
  EXPECT_EQ(error(R"("trails": 100)")["message"],
            "request: unknown key /trails; did you mean /trials?");
  EXPECT_EQ(error(R"("changes": 3)")["message"],
            "request: /changes: found 3; expected a list of objects");
  EXPECT_EQ(error(R"("trials": 1)")["field"], "trials");
}

TEST(LabEngine, AnEdgeRequiresItsPlace) {
  for (const char* name : {"arm", "measurement", "edge", "position"}) {
    Json request = move_request("gate", 1, 0.3);
    request.erase(name);
    Json error = error_of(request.dump());
    EXPECT_EQ(error["field"], name);
    EXPECT_EQ(error["message"], std::string(name) + " = nothing; expected a value");
  }
}

TEST(LabEngine, ACommandRequiresItsName) {
  EXPECT_EQ(error_of(R"({"call": "command", "built_in": "paper-10f0"})")["message"],
            "what = nothing; expected camera, codes, evaluate, scene, design, export");
}

TEST(LabEngine, EvaluationsAndDesignsHaveTheirOwnRangesOfTrials) {
  Json request = {{"call", "command"}, {"what", "evaluate"}, {"codes", {"square-k4"}}};
  for (const std::int64_t trials : {std::int64_t{2}, std::int64_t{4'000'000'000}}) {
    request["trials"] = trials;
    EXPECT_EQ(ask(request).json["command"],
              "tofsmith evaluate square-k4 --trials " + std::to_string(trials));
  }
  for (const int trials : {999, 100'000'001})
    EXPECT_EQ(error_of(Json{{"call", "design"}, {"trials", trials}}.dump())["field"], "trials");
}

}  // namespace
}  // namespace tofsmith::lab
