// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <string>
#include <vector>

#include "arrays.hpp"
#include "reports.hpp"
#include "tofsmith/core/fields.hpp"

// Conversion between results and dicts of numbers and arrays with the names of their fields. An
// estimate x_m becomes x_m and its standard error x_se_m. A list of structs becomes one array (or
// list of texts) per field; the prefix "point_" resolves name conflicts.
namespace tofsmith::python {

/// Calls `visit` with the name and value of every number and text of a struct.
template <typename Struct, typename Visit>
void for_each_entry(Struct& its, Visit&& visit) {
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    if constexpr (std::is_same_v<Value, Estimate>) {
      visit(std::string(field.name), field.value.value);
      if (!field.is(FieldMark::without_error))
        visit(error_name(field.name), field.value.standard_error);
    } else if constexpr (HasFields<Value>) {
      for_each_entry(field.value, visit);
    } else {
      visit(std::string(field.name), field.value);
    }
  });
}

/// Returns entry number `index` of every struct; all have the type `Value`.
template <typename Value, typename Structs, typename Visit>
void for_each_of_column(Structs& items, int index, Visit&& visit) {
  for (auto& item : items) {
    int i = 0;
    for_each_entry(item, [&](const std::string&, auto& value) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, Value>)
        if (i == index) visit(value);
      ++i;
    });
  }
}

template <typename Struct>
void add_columns(py::dict& dict, const std::vector<Struct>& items) {
  const Struct blank{};
  int index = 0;
  for_each_entry(blank, [&](const std::string& name, const auto& any) {
    using Value = std::remove_cvref_t<decltype(any)>;
    std::vector<Value> column;
    for_each_of_column<Value>(items, index++, [&](const Value& value) { column.push_back(value); });
    const py::str key = dict.contains(name) ? "point_" + name : name;
    if constexpr (std::is_same_v<Value, std::string>)
      dict[py::str(name + "s")] = column;
    else if constexpr (std::is_same_v<Value, bool>)
      dict[key] = py::array_t<bool>(py::cast(column));
    else
      dict[key] = adopt(std::move(column));
  });
}

template <typename Value>
inline constexpr bool is_struct_list = is_list<Value>&& HasFields<SingleValue<Value>>;

template <typename Struct>
py::dict fields_dict(const Struct& its);

/// Converts the value of a field that is not an estimate with a separate standard error.
template <typename Value>
py::object object_of(const Value& value) {
  if constexpr (is_optional<Value>) {
    return value ? object_of(*value) : py::none();
  } else if constexpr (std::is_same_v<Value, Estimate>) {
    return pair_of(value);
  } else if constexpr (HasFields<Value>) {
    return fields_dict(value);
  } else if constexpr (is_struct_list<Value> || std::is_same_v<Value, std::vector<Estimate>>) {
    py::list items;
    for (const auto& item : value) items.append(object_of(item));
    return items;
  } else if constexpr (std::is_same_v<Value, Image<float>>) {
    return adopt(Image<float>(value));
  } else if constexpr (std::is_base_of_v<Eigen::EigenBase<Value>, Value>) {
    return adopt(Value(value));
  } else if constexpr (std::is_same_v<Value, ImpulseResponse>) {
    return impulse_response_dict(value);
  } else if constexpr (std::is_enum_v<Value>) {
    return py::str(std::string(name_of(value)));
  } else {
    return py::cast(value);
  }
}

template <typename Struct>
py::dict fields_dict(const Struct& its) {
  py::dict dict;
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    if (!field.is(FieldMark::as_object)) {
      if constexpr (std::is_same_v<Value, Estimate>) {
        dict[field.name] = field.value.value;
        dict[py::str(error_name(field.name))] = field.value.standard_error;
        return;
      } else if constexpr (is_struct_list<Value>) {
        return add_columns(dict, field.value);
      }
    }
    dict[field.name] = object_of(field.value);
  });
  return dict;
}

/// @throws std::invalid_argument naming a column whose length differs from the previous ones
template <typename Struct>
void read_columns(const py::dict& values, std::vector<Struct>& items) {
  Struct blank{};
  int index = 0;
  for_each_entry(blank, [&](const std::string& name, const auto& any) {
    using Value = std::remove_cvref_t<decltype(any)>;
    const std::string point_name = "point_" + name;
    const py::str key = values.contains(point_name) ? point_name : name;
    const auto column = py::cast<std::vector<Value>>(values[key]);
    if (index == 0) items.resize(column.size());
    if (column.size() != items.size())
      refuse(name, std::to_string(column.size()) + " values",
             "one for each of " + std::to_string(items.size()) + " operating points");
    std::size_t i = 0;
    for_each_of_column<Value>(items, index++, [&](Value& value) { value = column[i++]; });
  });
}

/// Inverse of fields_dict(). @throws pybind11 errors for missing fields and wrong types
template <typename Struct>
Struct fields_from_dict(const py::dict& values) {
  Struct its;
  for_each_field(its, [&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(field.value)>;
    if constexpr (std::is_same_v<Value, Estimate>)
      field.value = {py::cast<double>(values[field.name]),
                     py::cast<double>(values[py::str(error_name(field.name))])};
    else if constexpr (HasFields<Value>)
      field.value = fields_from_dict<Value>(values[field.name]);
    else if constexpr (is_list<Value>)
      read_columns(values, field.value);
    else
      field.value = py::cast<Value>(values[field.name]);
  });
  return its;
}

}  // namespace tofsmith::python
