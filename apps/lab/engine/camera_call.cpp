// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "camera_call.hpp"

#include <cmath>
#include <string>

#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith::lab {

namespace {

/// Returns the value of a dotted key such as "light.peak_factor" in a document; null if it is not
/// set.
Json value_at(const Json& document, std::string_view key) {
  const Json* at = &document;
  for (;;) {
    const std::size_t dot = key.find('.');
    const auto found = at->find(std::string(key.substr(0, dot)));
    if (found == at->end()) return nullptr;
    if (dot == std::string_view::npos) return *found;
    at = &*found;
    if (!at->is_object()) return nullptr;
    key.remove_prefix(dot + 1);
  }
}

/// Returns the type of a field on the page, where several value types are lists.
std::string_view type_of(const KeyDescription& described, const Json& value) {
  switch (described.type) {
    case ValueType::numbers:
    case ValueType::integers:
    case ValueType::number_pair:
    case ValueType::raw_numbers:
      return "list";
    case ValueType::number_or_list:
      return value.is_array() ? "list" : "number";
    case ValueType::number_or_word:
      return "number";
    case ValueType::path:
      return "text";
    default:
      return name_of(described.type);
  }
}

void add_bounds(Json& field, const Key& key) {
  if (field["type"] != "number" && field["type"] != "integer" && field["type"] != "list") return;
  const bool has_low = std::isfinite(key.range.low), has_high = std::isfinite(key.range.high);
  if (has_low) field["low"] = key.range.low;
  if (has_high) field["high"] = key.range.high;
  double from = 0.0, to = 1.0;
  if (key.usual_high > key.usual_low) {
    from = key.usual_low;
    to = key.usual_high;
  } else if (has_low && has_high) {
    from = key.range.low;
    to = key.range.high;
  } else if (const Json& value = field["value"]; value.is_number() && value.get<double>() > 0.0) {
    from = value.get<double>() / 10.0;
    to = value.get<double>() * 10.0;
  } else if (field["unit"] == "s") {
    to = 1e-8;
  }
  field["usual"] = {from, to};
  field["log"] = from > 0.0 && to / from >= 50.0;
}

Json field_json(const KeyDescription& described, const Json& document, const Json& defaults) {
  const std::string& name = described.name;
  const Key& key = described.key;
  const std::size_t dot = name.rfind('.');
  const Json value = value_at(document, name);
  Json field = {{"key", name},
                {"section", dot == std::string::npos ? "" : name.substr(0, dot)},
                {"unit", unit_of_key(name)},
                {"doc", key.help},
                {"type", type_of(described, value)},
                {"value", value},
                {"default", value_at(defaults, name)},
                {"expert", !key.is_basic}};
  if (!described.words.empty()) field["choices"] = described.words;
  add_bounds(field, key);
  return field;
}

}  // namespace

Answer camera_answer(const Camera& camera) {
  const Json document = Json::parse(camera_to_json(camera));
  Camera blank;
  blank.operating = default_operating_range();
  const Json defaults = Json::parse(camera_to_json(blank));
  Answer answer;
  answer["name"] = camera.name;
  answer["toml"] = camera_to_toml(camera);
  answer["range_m"] = camera.range_m();
  Json& fields = answer["fields"] = Json::array();
  for (const KeyDescription& described : describe_camera_keys(camera))
    if (described.key.applies && described.type != ValueType::table)
      fields.push_back(field_json(described, document, defaults));
  answer["warnings"] = Json::array();
  return answer;
}

}  // namespace tofsmith::lab
