// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/text/shared/reader.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/core/statistics.hpp"

namespace tofsmith {

// Conversion of structs to and from JSON objects by their fields (core/fields.hpp). Numbers that
// are not finite become null. In lists, structs that contain only doubles become lists.

nlohmann::ordered_json estimate_json(const Estimate& estimate);

/// An estimate "x_m" is written as "x_m" and its standard error "x_se_m". Absent optional values
/// are omitted.
template <typename Value>
void write_field(nlohmann::ordered_json& object, const Field<Value>& field);

/// Omits fields with one of the marks `but`.
template <typename Struct>
nlohmann::ordered_json fields_json(const Struct& its, unsigned but = as_bits(FieldMark::apart)) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for_each_field(its, [&](const auto& field) {
    if ((field.marks & but) == 0) write_field(object, field);
  });
  return object;
}

template <typename Struct>
nlohmann::ordered_json row_json(const Struct& its) {
  nlohmann::ordered_json row = nlohmann::ordered_json::array();
  for_each_field(its, [&](const auto& field) { row.push_back(field.value); });
  return row;
}

/// Inverse of fields_json(), without FieldMark::apart fields.
/// @throws IoError naming file and member if it is missing or out of range
template <typename Struct>
Struct fields_from_json(const ValueReader& json);
template <typename Struct>
Struct row_from_json(const ValueReader& json);

namespace detail {

/// Null is infinity if the range includes infinity.
double read_number(const ValueReader& json, const Range& range);
int read_integer(const ValueReader& json, const Range& range);
void read_estimate(const ValueReader& object, const Field<Estimate>& field);

template <typename Value>
void read_value(const ValueReader& json, Value& value, const Range& range) {
  if constexpr (std::is_same_v<Value, double>)
    value = read_number(json, range);
  else if constexpr (std::is_same_v<Value, int>)
    value = read_integer(json, range);
  else
    json.read(value);
}

template <typename Struct>
void read_fields(const ValueReader& json, Struct& its);

template <typename Value>
void read_field(const ValueReader& object, const Field<Value>& field) {
  if (field.is(FieldMark::apart)) return;
  if constexpr (std::is_same_v<Value, Estimate>) {
    read_estimate(object, field);
  } else if constexpr (HasFields<Value>) {
    read_fields(field.is(FieldMark::in_place) ? object : object.member(field.document_name),
                field.value);
  } else {
    const ValueReader json = object.member(field.document_name);
    if (field.is(FieldMark::may_be_null) && json.is_null()) return;
    if constexpr (is_optional<Value>) {
      if (!json.is_null()) read_fields(json, field.value.emplace());
    } else if constexpr (is_list<Value>) {
      using Item = typename Value::value_type;
      for (const ValueReader& item : json.elements())
        if constexpr (!HasFields<Item>)
          read_value(item, field.value.emplace_back(), field.range);
        else if constexpr (is_row<Item>)
          field.value.push_back(row_from_json<Item>(item));
        else
          field.value.push_back(fields_from_json<Item>(item));
    } else if constexpr (std::is_enum_v<Value>) {
      field.value = static_cast<Value>(json.word(all_words<Value>));
    } else {
      read_value(json, field.value, field.range);
    }
  }
}

template <typename Struct>
void read_fields(const ValueReader& json, Struct& its) {
  for_each_field(its, [&](const auto& field) { read_field(json, field); });
}

}  // namespace detail

template <typename Struct>
Struct fields_from_json(const ValueReader& json) {
  Struct its;
  detail::read_fields(json, its);
  return its;
}

template <typename Struct>
Struct row_from_json(const ValueReader& json) {
  Struct its;
  std::string names;
  std::size_t count = 0;
  for_each_field(its, [&](const auto& field) {
    names += (count++ == 0 ? "" : ", ") + std::string(field.name);
  });
  const std::vector<ValueReader> row = json.elements(count, names);
  count = 0;
  for_each_field(
      its, [&](const auto& field) { detail::read_value(row[count++], field.value, field.range); });
  return its;
}

template <typename Value>
void write_field(nlohmann::ordered_json& object, const Field<Value>& field) {
  using Type = std::remove_const_t<Value>;
  const std::string name(field.document_name);
  if constexpr (std::is_same_v<Type, Estimate>) {
    if (field.is(FieldMark::as_object)) {
      object[name] = estimate_json(field.value);
    } else {
      object[name] = field.value.value;
      if (!field.is(FieldMark::without_error))
        object[error_name(field.document_name)] = field.value.standard_error;
    }
  } else if constexpr (HasFields<Value>) {
    if (field.is(FieldMark::in_place))
      object.update(fields_json(field.value));
    else
      object[name] = fields_json(field.value);
  } else if constexpr (is_optional<Type>) {
    using Content = typename Type::value_type;
    if constexpr (HasFields<Content>) {
      object[name] = field.value ? fields_json(*field.value) : nlohmann::ordered_json();
    } else if (field.value) {
      if constexpr (std::is_enum_v<Content>)
        object[name] = name_of(*field.value);
      else
        object[name] = *field.value;
    }
  } else if constexpr (is_list<Type>) {
    object[name] = nlohmann::ordered_json::array();
    for (const auto& item : field.value)
      if constexpr (!HasFields<typename Type::value_type>)
        object[name].push_back(item);
      else if constexpr (is_row<typename Type::value_type>)
        object[name].push_back(row_json(item));
      else
        object[name].push_back(fields_json(item));
  } else if constexpr (std::is_enum_v<Type>) {
    object[name] = name_of(field.value);
  } else if constexpr (std::is_same_v<Type, double>) {
    // 0 means that there is no bound.
    if (field.is(FieldMark::bound) && field.is(FieldMark::may_be_null) && field.value == 0.0)
      object[name] = nullptr;
    else
      object[name] = field.value;
  } else {
    object[name] = field.value;
  }
}

}  // namespace tofsmith
