// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "answer.hpp"

#include <fmt/format.h>

#include <array>
#include <exception>
#include <new>
#include <stdexcept>

#include "code_call.hpp"
#include "request.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/decode/filter.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/scene/built_in_scenes.hpp"
#include "tofsmith/version.hpp"
#include "work_calls.hpp"

namespace tofsmith::lab {

namespace {

/// Exceeds any valid camera or code.
constexpr std::size_t max_request_bytes = std::size_t{32} << 20;

/// Names of concrete codes: common members of each family.
constexpr std::array shown_families = {
    "sinusoid-k3",    "sinusoid-k4",       "square-k4",
    "hamiltonian-k3", "hamiltonian-k4",    "hamiltonian-k5",
    "hamiltonian-k6", "multifrequency-k5", "pulsed-multifrequency-k4",
    "single-ramp-k3", "double-ramp-k3",    "pulsed-multifrequency-k5",
    "gray-k4"};

Answer about() {
  Answer answer;
  answer["version"] = TOFSMITH_VERSION;
  answer["families"] = shown_families;
  answer["cameras"] = built_in_camera_names();
  answer["scenes"] = built_in_scene_names();
  Json filters = Json::array();
  for (const FilterStrength strength : all_values<FilterStrength>)
    filters.push_back(name_of(strength));
  answer["filters"] = std::move(filters);
  return answer;
}

Answer set(const Request& request) {
  const Change asked{request.text("key"),
                     request.has("value") ? std::optional(request.text("value")) : std::nullopt};
  const auto [camera, resolved] = changed(request.camera(), asked);
  Answer answer = camera_answer(camera);
  answer["change"] = {{"key", resolved.key},
                      {"value", resolved.value ? Json(*resolved.value) : Json()}};
  return answer;
}

Answer code(const Request& request) {
  const Camera camera = request.camera();
  return code_answer(request.code(camera), camera);
}

Answer move_edge(const Request& request) {
  const Camera camera = request.camera();
  const CodeSet before = request.code(camera);
  const std::string arm = request.text("arm");
  require(arm == "light" || arm == "gate", "arm", arm, "expected light or gate");
  const EdgePlace place{arm == "light",
                        static_cast<int>(request.integer("measurement", 0, 1'000'000)),
                        static_cast<std::size_t>(request.integer("edge", 0, 1'000'000))};
  const CodeSet edited = with_edge_moved(before, camera, place, request.number("position"));
  Answer answer = code_answer(edited, camera);
  answer["file"] = code_to_json(edited);
  return answer;
}

Answer save_code(const Request& request) {
  Answer answer;
  const CodeSet code = request.code(request.camera());
  answer["name"] = code.name();
  answer["file"] = code_to_json(code);
  return answer;
}

Answer call(std::string_view name, const Request& request, const Progress& progress) {
  if (name == "about") return about();
  if (name == "camera") return camera_answer(request.camera());
  if (name == "set") return set(request);
  if (name == "code") return code(request);
  if (name == "move_edge") return move_edge(request);
  if (name == "save_code") return save_code(request);
  if (name == "evaluate") return evaluate_answer(request, progress);
  if (name == "scene") return scene_answer(request, progress);
  if (name == "design") return design_answer(request, progress);
  if (name == "command") return command_answer(request);
  reject("call", name,
         "expected about, camera, set, code, move_edge, save_code, evaluate, scene, design or "
         "command");
}

}  // namespace

Reply answer(std::string_view request, const Progress& progress) {
  try {
    if (request.size() > max_request_bytes)
      return error_reply(
          fmt::format("found {} bytes; expected at most {}", request.size(), max_request_bytes));
    const nlohmann::json json = nlohmann::json::parse(request);
    require(json.is_object(), "request", json.type_name(), "expected an object");
    const Request arguments(json);
    return call(arguments.text("call"), arguments, progress).reply();
  } catch (const InvalidArgument& error) {
    return error_reply(error.what(), error.field());
  } catch (const std::bad_alloc&) {
    return error_reply(
        "this requires more memory than a web page can use; reduce the number of samples or "
        "pixels");
  } catch (const std::length_error&) {
    return error_reply(
        "this requires more memory than a web page can use; reduce the number of samples or "
        "pixels");
  } catch (const std::exception& error) {
    return error_reply(error.what());
  }
}

}  // namespace tofsmith::lab
