// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "arrays.hpp"

namespace tofsmith::python {

template <typename Value>
inline constexpr bool is_optional = false;
template <typename Value>
inline constexpr bool is_optional<std::optional<Value>> = true;

/// What a Python value must be to become a `Value`, in words.
template <typename Value>
std::string needed() {
  if constexpr (is_optional<Value>) {
    return needed<typename Value::value_type>();
  } else if constexpr (std::is_same_v<Value, bool>) {
    return "True or False";
  } else if constexpr (std::is_integral_v<Value>) {
    using Limits = std::numeric_limits<Value>;
    return "a whole number from " + std::to_string(Limits::min()) + " to " +
           std::to_string(Limits::max());
  } else if constexpr (std::is_floating_point_v<Value>) {
    return "a number";
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return "a text";
  } else if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
    return "a list of texts";
  } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
    return "a list of whole numbers";
  } else {
    return "a list of numbers";
  }
}

/// How a refusal shows what was given: "str 'abc'".
std::string shown(py::handle value);

/// Sets fields of an options struct from a dict of their names. None leaves the default.
class OptionReader {
 public:
  /// @param owner  what the options belong to, for errors: "factorize"; "" for arguments themselves
  OptionReader(const py::dict& values, std::string owner);

  template <typename Value>
  OptionReader& value(const char* name, Value& field) {
    const py::object given = take(name);
    if (given.is_none()) return *this;
    // A bool must be one; a text is no list.
    py::detail::make_caster<Value> caster;
    if (!caster.load(given, !std::is_same_v<Value, bool>)) wrong_type(name, given, needed<Value>());
    field = py::detail::cast_op<Value&>(caster);
    return *this;
  }
  /// A field that a function makes of a text.
  template <typename Value, typename Parse>
  OptionReader& word(const char* name, Value& field, Parse parse) {
    std::string text;
    value(name, text);
    if (!text.empty()) field = parse(text);
    return *this;
  }
  /// The entry, a dict of its own, or an empty one.
  py::dict table(const char* name);
  /// @throws std::invalid_argument for names that no field has, with the nearest that one has
  void finish() const;

 private:
  py::object take(const char* name);
  [[noreturn]] void wrong_type(const char* name, py::handle given, const std::string& needs) const;
  std::string full_name(const std::string& name) const;

  py::dict values_;
  std::string owner_;
  std::vector<std::string> known_;
};

}  // namespace tofsmith::python
