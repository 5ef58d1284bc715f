// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/camera/camera.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/core/statistics.hpp"

// The descriptions of options and results as JSON, from which other languages derive theirs.
namespace tofsmith {

namespace detail {

/// "integer", "number", "choice", ...; of a list "integer[]"; of a pair "integer[2]"; of another
/// described struct "table".
template <typename Value>
std::string type_of_field() {
  if constexpr (is_optional<Value>)
    return type_of_field<typename Value::value_type>();
  else if constexpr (is_list<Value>)
    return type_of_field<typename Value::value_type>() + "[]";
  else if constexpr (NumberPair<Value>)
    return type_of_field<NumberOf<Value>>() + "[2]";
  else if constexpr (HasFields<Value>)
    return "table";
  else if constexpr (std::is_same_v<Value, Estimate>)
    return "estimate";
  else if constexpr (std::is_same_v<Value, Image<float>>)
    return "image";
  else if constexpr (std::is_base_of_v<Eigen::EigenBase<Value>, Value>)
    return "matrix";
  else if constexpr (std::is_same_v<Value, ImpulseResponse>)
    return "response";
  else if constexpr (std::is_same_v<Value, bool>)
    return "boolean";
  else if constexpr (std::is_integral_v<Value>)
    return "integer";
  else if constexpr (std::is_arithmetic_v<Value>)
    return "number";
  else if constexpr (std::is_enum_v<Value>)
    return "choice";
  else if constexpr (std::is_same_v<Value, std::filesystem::path>)
    return "path";
  else
    return "text";
}

template <typename Value>
nlohmann::ordered_json default_of_field(const Value& value) {
  if constexpr (is_optional<Value>) {
    return value ? default_of_field(*value) : nlohmann::ordered_json();
  } else if constexpr (is_list<Value>) {
    nlohmann::ordered_json items = nlohmann::ordered_json::array();
    for (const auto& item : value) items.push_back(default_of_field(item));
    return items;
  } else if constexpr (HasWords<Value>) {
    return name_of(value);
  } else if constexpr (std::is_same_v<Value, std::filesystem::path>) {
    return value.string();
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>) {
    return value;
  } else {  // a struct
    return nullptr;
  }
}

template <typename Single>
std::vector<std::string> words_of_field() {
  if constexpr (HasWords<Single>) {
    return {all_words<Single>.begin(), all_words<Single>.end()};
  } else {
    return {};
  }
}

}  // namespace detail

/// Lists the fields that users set, with the fields of nested structs.
template <typename Struct>
nlohmann::ordered_json fields_list(const Struct& its = {}) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    using Single = SingleValue<Value>;
    if (field.is(FieldMark::from_above) || field.is(FieldMark::apart)) return;
    const std::string range =
        field.range.is_restricted ? field.range.text(std::is_integral_v<Single>) : "";
    nlohmann::ordered_json described = {{"name", field.name},
                                        {"type", detail::type_of_field<Value>()},
                                        {"default", detail::default_of_field(field.value)},
                                        {"help", full_help(field.unit(), field.help, {}, {})},
                                        {"unit", field.unit()},
                                        {"range", range},
                                        {"words", detail::words_of_field<Single>()},
                                        {"only_with", field.only_with},
                                        {"if_absent", field.if_absent}};
    if constexpr (HasFields<Single>) described["fields"] = fields_list<Single>();
    list.push_back(std::move(described));
  });
  return list;
}

/// Lists all fields of a result, with the fields of nested structs.
template <typename Struct>
nlohmann::ordered_json result_fields(const Struct& its = {}) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    nlohmann::ordered_json described = {{"name", field.name},
                                        {"type", detail::type_of_field<Value>()},
                                        {"optional", is_optional<Value>},
                                        {"as_object", field.is(FieldMark::as_object)},
                                        {"help", field.help},
                                        {"unit", unit_of_key(field.name)}};
    if constexpr (std::is_same_v<SingleValue<Value>, Estimate>)
      described["error"] = field.is(FieldMark::without_error) ? "" : error_name(field.name);
    if constexpr (HasFields<SingleValue<Value>>)
      described["fields"] = result_fields<SingleValue<Value>>();
    list.push_back(std::move(described));
  });
  return list;
}

}  // namespace tofsmith
