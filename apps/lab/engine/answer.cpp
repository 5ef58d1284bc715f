// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "answer.hpp"

#include <fmt/format.h>

#include <array>
#include <exception>
#include <new>
#include <stdexcept>

#include "code_call.hpp"
#include "io/documents/shared/document_text.hpp"
#include "io/text/shared/reader.hpp"
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

/// Converts JSON to text. Invalid UTF-8 (e.g. in names from files) is replaced; non-finite numbers
/// become null.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// @param field  empty: unknown
Reply error_reply(std::string_view message, std::string_view field = "") {
  Json error = {{"message", message}};
  if (!field.empty()) error["field"] = field;
  return {text_of(Json{{"error", std::move(error)}}), {}};
}

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

Answer camera(const CameraArguments& arguments) { return camera_answer(arguments.load()); }

Answer set(const CameraArguments& arguments, const Change& change) {
  const auto [camera, resolved] = changed(arguments.load(), change);
  Answer answer = camera_answer(camera);
  answer["change"] = {{"key", resolved.key},
                      {"value", resolved.value ? Json(*resolved.value) : Json()}};
  return answer;
}

Answer code(const CodeArguments& arguments) {
  const Camera camera = arguments.camera.load();
  return code_answer(arguments.code.load(camera), camera);
}

Answer move_edge(const CodeArguments& arguments, const EdgeMove& move) {
  const Camera camera = arguments.camera.load();
  const CodeSet edited = with_edge_moved(arguments.code.load(camera), camera, move);
  Answer answer = code_answer(edited, camera);
  answer["file"] = code_to_json(edited);
  return answer;
}

Answer save_code(const CodeArguments& arguments) {
  Answer answer;
  const CodeSet code = arguments.code.load(arguments.camera.load());
  answer["name"] = code.name();
  answer["file"] = code_to_json(code);
  return answer;
}

template <typename Arguments>
void read_arguments(TableReader& table, Arguments& arguments) {
  for_each_field(arguments, [&](const auto& field) {
    using Value = std::remove_reference_t<decltype(field.value)>;
    if constexpr (std::is_same_v<Value, std::vector<Change>>)
      table.tables(field.name, [&](TableReader& change) {
        read_arguments(change, field.value.emplace_back());
      });
    else if constexpr (!HasFields<Value>)
      table.value(field.name, field.value);
    else if (field.is(FieldMark::in_place))
      read_arguments(table, field.value);
    else
      table.table(field.name, field.value, read_arguments<Value>);
  });
}

Answer call(TableReader& request, const Progress& progress) {
  std::string name;
  request.value("call", name);
  const auto answered_by = [&](auto function, auto... arguments) {
    (read_arguments(request, arguments), ...);
    request.finish();
    (check_fields(arguments), ...);
    if constexpr (std::is_invocable_v<decltype(function), decltype(arguments)..., Progress>)
      return function(arguments..., progress);
    else
      return function(arguments...);
  };
  if (name == "about") return about();
  if (name == "camera") return answered_by(camera, CameraArguments());
  if (name == "set") return answered_by(set, CameraArguments(), Change());
  if (name == "code") return answered_by(code, CodeArguments());
  if (name == "move_edge") return answered_by(move_edge, CodeArguments(), EdgeMove());
  if (name == "save_code") return answered_by(save_code, CodeArguments());
  if (name == "evaluate") return answered_by(evaluate_answer, CodeArguments(), EvaluateOptions());
  if (name == "scene") return answered_by(scene_answer, CodeArguments(), SceneArguments());
  if (name == "design")
    return answered_by(design_answer, CameraArguments(), DesignArguments(), DesignTrials());
  if (name == "command")
    return answered_by(command_answer, CameraArguments(), CommandArguments(), SceneArguments(),
                       DesignArguments());
  reject("call", name,
         "expected about, camera, set, code, move_edge, save_code, evaluate, scene, design or "
         "command");
}

}  // namespace

Reply Answer::reply() && {
  return {text_of(Json{{"answer", std::move(json_)}}), std::move(arrays_)};
}

Reply answer(std::string_view request, const Progress& progress) {
  try {
    if (request.size() > max_request_bytes)
      return error_reply(
          fmt::format("found {} bytes; expected at most {}", request.size(), max_request_bytes));
    const Document document = parse_json(request, "request");
    TableReader arguments(document);
    return call(arguments, progress).reply();
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
