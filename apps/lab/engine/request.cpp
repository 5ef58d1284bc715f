// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "request.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::lab {

namespace {

/// Converts JSON to text. Invalid UTF-8 (e.g. in names from files) is replaced; non-finite numbers
/// become null.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

constexpr std::size_t max_changes = 1000;

/// Placeholder for codes without a file; the page saves them under this name.
constexpr const char* code_file_name = "code.json";

}  // namespace

Reply Answer::reply() && {
  return {text_of(Json{{"answer", std::move(json_)}}), std::move(arrays_)};
}

Reply error_reply(std::string_view message, std::string_view field) {
  Json error = {{"message", message}};
  if (!field.empty()) error["field"] = field;
  return {text_of(Json{{"error", std::move(error)}}), {}};
}

void Request::refuse(const char* name, const char* expected) const {
  const auto found = json_.find(name);
  std::string text = found == json_.end()
                         ? "nothing"
                         : found->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 60) + "...";
  throw InvalidArgument({name, text, fmt::format("expected {}", expected)});
}

bool Request::has(const char* name) const {
  const auto found = json_.find(name);
  return found != json_.end() && !found->is_null();
}

std::string Request::text(const char* name) const {
  const auto found = json_.find(name);
  if (found == json_.end() || !found->is_string()) refuse(name, "a text");
  return found->get<std::string>();
}

std::string Request::text(const char* name, const std::string& otherwise) const {
  return has(name) ? text(name) : otherwise;
}

double Request::number(const char* name) const {
  const auto found = json_.find(name);
  if (found == json_.end() || !found->is_number() || !std::isfinite(found->get<double>()))
    refuse(name, "a finite number");
  return found->get<double>();
}

std::optional<double> Request::optional_number(const char* name) const {
  if (!has(name)) return std::nullopt;
  return number(name);
}

std::int64_t Request::integer(const char* name, std::int64_t low, std::int64_t high) const {
  const std::string expected = fmt::format("an integer in [{}, {}]", low, high);
  const auto found = json_.find(name);
  if (found == json_.end() || !found->is_number()) refuse(name, expected.c_str());
  const double value = found->get<double>();
  if (!(value >= static_cast<double>(low) && value <= static_cast<double>(high)) ||
      value != std::floor(value))
    refuse(name, expected.c_str());
  return static_cast<std::int64_t>(value);
}

std::int64_t Request::integer(const char* name, std::int64_t low, std::int64_t high,
                              std::int64_t otherwise) const {
  return has(name) ? integer(name, low, high) : otherwise;
}

std::vector<std::string> Request::texts(const char* name) const {
  std::vector<std::string> texts;
  if (!has(name)) return texts;
  if (!json_[name].is_array()) refuse(name, "a list of texts");
  for (const nlohmann::json& text : json_[name]) {
    if (!text.is_string()) refuse(name, "a list of texts");
    texts.push_back(text.get<std::string>());
  }
  return texts;
}

std::vector<Change> Request::changes() const {
  std::vector<Change> changes;
  if (!has("changes")) return changes;
  constexpr const char* expected =
      "a list of at most 1000 {\"key\": text, \"value\": text or null}";
  const nlohmann::json& list = json_["changes"];
  if (!list.is_array() || list.size() > max_changes) refuse("changes", expected);
  for (const nlohmann::json& item : list) {
    if (!item.is_object()) refuse("changes", expected);
    const auto key = item.find("key"), value = item.find("value");
    const bool has_value = value != item.end() && !value->is_null();
    if (key == item.end() || !key->is_string() || (has_value && !value->is_string()))
      refuse("changes", expected);
    Change& change = changes.emplace_back(Change{key->get<std::string>(), std::nullopt});
    if (has_value) change.value = value->get<std::string>();
  }
  return changes;
}

Camera Request::camera() const {
  Camera camera = has("built_in") ? load_camera(text("built_in"))
                                  : parse_camera_toml(text("camera"), "camera.toml");
  for (const Change& change : changes()) camera = changed(camera, change).first;
  return camera;
}

CodeSet Request::code(const Camera& camera) const {
  constexpr const char* expected = "{\"name\": a family} or {\"file\": text of a code file}";
  const auto found = json_.find("code");
  if (found == json_.end() || !found->is_object()) refuse("code", expected);
  const auto name = found->find("name"), file = found->find("file");
  if (file != found->end() && file->is_string()) {
    CodeSet code = parse_code_json(file->get_ref<const std::string&>(), code_file_name);
    require_fits(code, camera);
    return code;
  }
  if (name == found->end() || !name->is_string()) refuse("code", expected);
  return load_code(name->get<std::string>(), camera);
}

std::pair<Camera, Change> changed(const Camera& camera, const Change& change) {
  // An empty text would remove the key; the page uses null for that.
  require(!change.value || change.value->find_first_not_of(" \t") != std::string::npos, change.key,
          "nothing", "expected a value");
  constexpr std::string_view kind = ".impulse_response.kind";
  Change resolved = change;
  if (change.value && change.key.ends_with(kind)) {
    resolved.key = change.key.substr(0, change.key.size() - std::string(".kind").size());
    const bool is_light = resolved.key.starts_with("light");
    const ImpulseResponse& before =
        is_light ? camera.light.impulse_response : camera.sensor.impulse_response;
    const double limit_hz = before.f_max_hz > 0.0    ? before.f_max_hz
                            : before.cutoff_hz > 0.0 ? before.cutoff_hz
                                                     : 10.0 * camera.fundamental_frequency_hz;
    std::string word = *change.value;
    std::erase(word, '"');
    if (word == "hann")
      resolved.value = fmt::format("{{ kind = \"hann\", f_max_hz = {} }}", limit_hz);
    else if (word == "gaussian" || word == "lowpass")
      resolved.value = fmt::format("{{ kind = \"{}\", cutoff_hz = {} }}", word, limit_hz);
    else
      resolved.value = fmt::format("{{ kind = \"{}\" }}", word);
  }
  const std::array settings = {resolved.key + "=" + resolved.value.value_or("")};
  return {with_settings(camera, settings), resolved};
}

}  // namespace tofsmith::lab
