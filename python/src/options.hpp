// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "arrays.hpp"
#include "tofsmith/core/fields.hpp"
#include "tofsmith/decode/multipath_decoder.hpp"
#include "tofsmith/design/design.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/decode_recording.hpp"
#include "tofsmith/waveforms/waveform_export.hpp"

namespace tofsmith::python {

/// Returns the required Python value for a `Value`, as text.
template <typename Value>
std::string needed() {
  if constexpr (is_optional<Value>) {
    return needed<typename Value::value_type>();
  } else if constexpr (std::is_same_v<Value, bool>) {
    return "True or False";
  } else if constexpr (std::is_integral_v<Value>) {
    using Limits = std::numeric_limits<Value>;
    if (std::is_signed_v<Value>) return "a whole number";  // further limited by rules
    return "a whole number from 0 to " + std::to_string(Limits::max());
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

/// Returns true if a Python value is converted to a whole number.
template <typename Value>
constexpr bool is_whole() {
  if constexpr (is_optional<Value>) return is_whole<typename Value::value_type>();
  return std::is_integral_v<Value> && !std::is_same_v<Value, bool>;
}

/// Returns true if users set fields of this type; the library sets the others.
template <typename Value>
constexpr bool is_given() {
  if constexpr (is_optional<Value> || is_list<Value>)
    return is_given<typename Value::value_type>();
  else
    return HasFields<Value> || HasWords<Value> || std::is_arithmetic_v<Value> ||
           std::is_same_v<Value, std::string> || std::is_same_v<Value, std::filesystem::path>;
}

/// Converts 1e4 to 10000; returns anything else unchanged.
py::object whole_number_of(const py::object& given);

/// Converts a sequence of numbers, or a single number, to a list; returns anything else unchanged.
/// @param whole  convert 1e4 to 10000
py::object as_numbers(const py::object& given, bool whole);

/// Returns a description of a value for errors: "str 'abc'".
std::string shown(py::handle value);

template <typename Options>
void read_options(const py::dict& values, const std::string& owner, Options& options);

/// Sets fields of an options struct from a dict of their names. None leaves the default.
class OptionReader {
 public:
  /// @param owner  owner of the options in errors: "factorize"; "" for arguments
  OptionReader(const py::dict& values, std::string owner);

  template <typename Value>
  OptionReader& value(const char* name, Value& field) {
    py::object given = take(name);
    if (given.is_none()) return *this;
    if constexpr (is_whole<Value>()) given = whole_number_of(given);
    if constexpr (is_list<Value>)
      if constexpr (std::is_arithmetic_v<typename Value::value_type>)
        given = as_numbers(given, is_whole<typename Value::value_type>());
    // A bool must be a bool, and a text is not a list.
    py::detail::make_caster<Value> caster;
    if (!caster.load(given, !std::is_same_v<Value, bool>)) wrong_type(name, given, needed<Value>());
    field = Value(py::detail::cast_op<Value&>(caster));  // assigning a copy makes GCC 14 warn
    return *this;
  }
  /// Sets a field from a text with a function.
  template <typename Value, typename Parse>
  OptionReader& word(const char* name, Value& field, Parse parse) {
    std::optional<std::string> text;
    value(name, text);
    if (text) field = parse(*text);
    return *this;
  }
  /// Sets a file name from a text or an os.PathLike.
  OptionReader& path(const char* name, std::filesystem::path& field);
  /// Sets all user-settable fields of a struct, except the named ones.
  template <typename Options>
  OptionReader& fields(Options& options, std::initializer_list<std::string_view> but = {}) {
    for_each_field(options, [&](const auto& field) {
      if constexpr (is_given<std::remove_reference_t<decltype(field.value)>>())
        if (std::ranges::find(but, field.name) == but.end() && !field.is(FieldMark::from_above) &&
            !field.is(FieldMark::apart))
          read(field.name, field.value);
    });
    return *this;
  }
  /// Returns an entry that is a dict; an empty dict without the entry.
  py::dict table(const char* name);
  /// @throws std::invalid_argument for unknown names, with the most similar known one
  void finish() const;

 private:
  template <typename Value>
  void read(const char* name, Value& field) {
    using Single = SingleValue<Value>;
    if constexpr (NumberPair<Single>) {
      read_pair<Single>(name, field);
    } else if constexpr (HasFields<Value>) {
      read_options(table(name), full_name(name), field);
    } else if constexpr (is_optional<Value> && HasFields<Single>) {
      const py::dict given = table(name);
      if (!given.empty()) read_options(given, full_name(name), field.emplace());
    } else if constexpr (is_list<Value> && HasWords<Single>) {
      std::vector<std::string> words;
      value(name, words);
      for (const std::string& text : words)
        field.push_back(parse_word<Single>(full_name(name), text));
    } else if constexpr (HasWords<Single>) {
      word(name, field,
           [&](const std::string& text) { return parse_word<Single>(full_name(name), text); });
    } else if constexpr (std::is_same_v<Value, std::filesystem::path>) {
      path(name, field);
    } else {
      value(name, field);
    }
  }
  template <NumberPair Pair, typename Value>
  void read_pair(const char* name, Value& field) {
    Pair pair;
    auto [first, second] = fields_of(pair);
    std::vector<NumberOf<Pair>> numbers;
    value(name, numbers);
    if (numbers.empty()) return;
    if (numbers.size() != 2)
      refuse(full_name(name), std::to_string(numbers.size()) + " numbers",
             std::string("(") + first.name + ", " + second.name + ")");
    first.value = numbers[0], second.value = numbers[1];
    field = pair;
  }
  py::object take(const char* name);
  [[noreturn]] void wrong_type(const char* name, py::handle given, const std::string& needs) const;
  std::string full_name(const std::string& name) const;

  py::dict values_;
  std::string owner_;
  std::vector<std::string> known_;
};

/// Reads all fields of an options struct from a dict.
/// @throws as OptionReader, also for unknown names
template <typename Options>
void read_options(const py::dict& values, const std::string& owner, Options& options) {
  OptionReader(values, owner).fields(options).finish();
}

/// Reads the options of two-return and tail decoding from a dict; `owner` is its name in errors.
/// @throws std::invalid_argument naming the violated rule or an unknown name
MultipathOptions multipath_options(const pybind11::dict& values, const std::string& owner,
                                   double range_m);

/// Options of an export from a dict; the format is the caller's.
/// @throws std::invalid_argument naming an unknown name, TypeError for a value of another type
ExportOptions export_options(const std::string& format, const pybind11::dict& values);

inline OutputPolicy policy_of(bool overwrite) {
  return overwrite ? OutputPolicy::overwrite : OutputPolicy::refuse_existing;
}

}  // namespace tofsmith::python
