// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/shared/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/shared/text_numbers.hpp"
#include "io/text/toml_hints.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {
namespace {

using Json = nlohmann::json;

std::string plain(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Returns a value that is not a list or a table, in TOML syntax.
std::string scalar(const Json& value) {
  if (value.is_binary()) return {value.get_binary().begin(), value.get_binary().end()};  // a date
  const bool is_finite = !value.is_number_float() || std::isfinite(value.get<double>());
  return is_finite ? plain(value) : fmt::format("{}", value.get<double>());
}

std::string one_line(const Json& value) {
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (!value.is_structured()) return scalar(value);
  std::vector<std::string> inside;
  for (const auto& [key, member] : value.items())
    inside.push_back(value.is_array() ? one_line(member)
                                      : fmt::format("{} = {}", plain(key), one_line(member)));
  const std::string list = fmt::format("{}", fmt::join(inside, ", "));
  return value.is_array() ? fmt::format("[{}]", list) : fmt::format("{{ {} }}", list);
}

/// Returns the path from one value to another, with a dot at the beginning of keys.
std::optional<std::string> path_between(const Json& from, const Json& to, Syntax syntax) {
  if (&from == &to) return "";
  if (!from.is_structured()) return std::nullopt;
  for (auto inner = from.begin(); inner != from.end(); ++inner) {
    const auto rest = path_between(*inner, to, syntax);
    if (!rest) continue;
    const std::string part =
        from.is_object() ? inner.key() : std::to_string(std::distance(from.begin(), inner));
    if (syntax == Syntax::json) return "/" + part + *rest;
    return (from.is_object() ? "." + part : "[" + part + "]") + *rest;
  }
  return std::nullopt;
}

}  // namespace

SettingValue setting_value(const Json& value, std::string place) {
  SettingValue setting{one_line(value), {}, {}, std::move(place)};
  setting.text = value.is_string() ? value.get<std::string>() : setting.toml;
  if (value.is_number() && std::isfinite(value.get<double>())) setting.number = value.get<double>();
  return setting;
}

Document::KeyAndValue Document::positions_of(const Json& value) const {
  const auto found = positions_->find(&value);
  return found == positions_->end() ? KeyAndValue() : found->second;
}

std::string Document::text_of(const Position& position) const {
  if (!position.setting.empty()) return position.setting;
  return fmt::format("{}:{}:{}", source_name_, position.line, position.column);
}

std::string Document::place_of(const Json& value) const {
  return positions_ ? text_of(positions_of(value).value) : source_name_;
}

std::string Document::place_of_key(const Json& value) const {
  return positions_ ? text_of(positions_of(value).key) : source_name_;
}

std::string Document::place_of_field(std::string_view field) const {
  const Json* value = &root_;
  while (value->is_object()) {
    const auto is_separator = [](char c) { return !is_letter_or_digit(c) && c != '_'; };
    const auto end = std::find_if(field.begin(), field.end(), is_separator);
    const std::string key(field.begin(), end);
    const auto inner = value->find(key);
    if (inner == value->end()) break;
    value = &*inner;
    field.remove_prefix(std::min(key.size() + 1, field.size()));
  }
  return value == &root_ ? source_name_ : place_of(*value);
}

std::string Document::name_of(const Json& value) const {
  const std::string path = path_between(root_, value, syntax_).value_or("");
  return path.starts_with('.') ? path.substr(1) : path;
}

std::filesystem::path Document::directory_of(const Json& value) const {
  if (positions_ && !positions_of(value).value.setting.empty()) return {};
  return std::filesystem::path(source_name_).parent_path();
}

void ValueReader::fail(std::string_view problem) const {
  const std::string its_name = name();
  throw IoError(place(),
                its_name.empty() ? std::string(problem) : fmt::format("{}: {}", its_name, problem));
}

void ValueReader::mistyped(std::string_view expected) const {
  const std::string found = value_->is_object()  ? (is_toml() ? "a table" : "an object")
                            : value_->is_array() ? fmt::format("a list of {}", value_->size())
                                                 : scalar(*value_);
  fail(fmt::format("found {}; expected {}", found, expected));
}

void ValueReader::require_table(std::string_view expected) const {
  if (!value_->is_object()) mistyped(is_toml() ? expected : "an object");
}

double ValueReader::number(std::string_view expected) const {
  if (value_->is_number()) {
    if (!std::isfinite(value_->get<double>())) mistyped("a finite number");
    return value_->get<double>();
  }
  // "20 MHz" is a number with its unit; "20" is text.
  if (is_toml() && value_->is_string()) {
    const auto& text = value_->get_ref<const std::string&>();
    const auto number = number_in(text) ? std::nullopt : number_in_unit(text, unit_of_key(key_));
    if (number) return *number;
  }
  mistyped(expected);
}

double ValueReader::number(double low, double high, double tolerance) const {
  const double found = number();
  if (found < low - tolerance || found > high + tolerance)
    mistyped(high == infinity ? fmt::format("a number >= {}", low)
                              : fmt::format("a number in [{}, {}]", low, high));
  return found;
}

int ValueReader::integer(int low, int high) const {
  using Limits = std::numeric_limits<int>;
  const bool any = low == Limits::min() && high == Limits::max();
  const std::string expected =
      any ? "an integer" : fmt::format("an integer in [{}, {}]", low, high);
  const double found = value_->is_number() ? value_->get<double>() : 0.5;
  const bool is_whole = is_toml() && found == std::trunc(found);  // 1e4
  if (!value_->is_number_integer() && !is_whole) mistyped(expected);
  if (!(found >= low && found <= high)) mistyped(any ? "an integer of at most 32 bits" : expected);
  return static_cast<int>(found);
}

std::uint64_t ValueReader::unsigned_integer() const {
  if (!value_->is_number_unsigned()) mistyped("an integer in [0, 2^64)");
  return value_->get<std::uint64_t>();
}

bool ValueReader::boolean() const {
  if (!value_->is_boolean()) mistyped("true or false");
  return value_->get<bool>();
}

std::string ValueReader::text() const {
  if (!value_->is_string()) mistyped(is_toml() ? "a text in quotes" : "a text");
  return value_->get<std::string>();
}

std::size_t ValueReader::word(std::span<const std::string_view> words) const {
  const std::string text = value_->is_string() ? value_->get<std::string>() : "";
  const auto found = std::find(words.begin(), words.end(), text);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::string near = value_->is_string() ? nearest_word(text, words) : "";
  mistyped(fmt::format("one of \"{}\"{}", fmt::join(words, "\", \""),
                       near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

std::vector<ValueReader> ValueReader::elements(std::string_view expected) const {
  if (!value_->is_array()) mistyped(expected);
  std::vector<ValueReader> all;
  all.reserve(value_->size());
  for (const Json& element : *value_) all.push_back(ValueReader(*document_, element, key_));
  return all;
}

std::vector<ValueReader> ValueReader::elements(std::size_t count, std::string_view because) const {
  if (!value_->is_array() || value_->size() != count)
    mistyped(fmt::format("a list of {}{}{}", count, because.empty() ? "" : ": ", because));
  return elements();
}

void ValueReader::read(std::vector<int>& target) const {
  target.clear();
  for (const ValueReader& element : elements("a list of integers"))
    target.push_back(element.integer(-65535, 65535));
}

std::vector<double> ValueReader::numbers(std::size_t count, std::string_view expected) const {
  std::vector<double> list;
  read_list(list, expected);
  if (list.size() != count)
    fail(fmt::format("found {} numbers; expected {}", list.size(), expected));
  return list;
}

void ValueReader::read(Eigen::Vector3d& target) const {
  const std::vector<double> list = numbers(3, "a list of three numbers");
  target = {list[0], list[1], list[2]};
}

void ValueReader::read(std::array<double, 2>& target) const {
  const std::vector<double> list = numbers(2, "a list of two numbers");
  target = {list[0], list[1]};
}

void ValueReader::read_raw(std::vector<double>& target) const {
  target.clear();
  for (const ValueReader& element : elements("a list of numbers, such as [65535]")) {
    const Json& value = *element.value_;
    if (value.is_number_float())
      target.push_back(value.get<double>());
    else if (value == "nan")
      target.push_back(std::numeric_limits<double>::quiet_NaN());
    else if (value == "inf" || value == "-inf")
      target.push_back(value == "inf" ? infinity : -infinity);
    else
      target.push_back(element.number("a number, nan, inf or -inf"));
  }
}

void ValueReader::read_number_or_list(double& number, std::vector<double>& list) const {
  list.clear();
  if (value_->is_array()) {
    read(list);
    if (list.empty()) fail("found an empty list; expected at least one number");
  } else {
    number = this->number("a number or a list of numbers");
  }
}

void ValueReader::read_number_or_word(double& number, std::string_view word, bool& is_word) const {
  is_word = *value_ == word;
  if (!is_word) number = this->number(fmt::format("a number or \"{}\"", word));
}

void ValueReader::only(std::initializer_list<std::string_view> members) const {
  require_table("a table");
  for (const auto& [name, ignored] : value_->items()) {
    if (std::find(members.begin(), members.end(), name) != members.end()) continue;
    const std::string near = nearest_word(name, members);
    fail(fmt::format("unknown member \"{}\"; {}", name,
                     near.empty() ? fmt::format("expected {}", fmt::join(members, ", "))
                                  : fmt::format("did you mean \"{}\"?", near)));
  }
}

std::optional<ValueReader> ValueReader::optional_member(std::string_view name) const {
  require_table("a table");
  const auto found = value_->find(std::string(name));
  if (found == value_->end()) return std::nullopt;
  return ValueReader(*document_, *found, found.key());
}

ValueReader ValueReader::member(std::string_view name) const {
  if (const auto found = optional_member(name)) return *found;
  fail(fmt::format("found no member \"{}\"; expected one", name));
}

std::optional<ValueReader> TableReader::find(std::string_view key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return optional_member(key);
}

const Json& TableReader::value_or_table(std::string_view key) const {
  const auto found = value_->find(std::string(key));
  return found == value_->end() ? *value_ : *found;
}

std::string TableReader::full(std::string_view key) const {
  const std::string table = name();
  if (document_->syntax() == Syntax::json) return fmt::format("{}/{}", table, key);
  return table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

std::string TableReader::place_of(std::string_view key) const {
  return document_->place_of(value_or_table(key));
}

void TableReader::fail(std::string_view key, std::string_view problem) const {
  throw IoError(place_of(key), fmt::format("{}: {}", full(key), problem));
}

std::vector<TableReader> TableReader::enter_each(std::string_view key) {
  std::vector<TableReader> readers;
  const auto found = find(key);
  if (!found) return readers;
  const std::string expected =
      is_toml() ? fmt::format("tables that begin with [[{}]]", full(key)) : "a list of objects";
  for (const ValueReader& element : found->elements(expected))
    readers.emplace_back(element, expected);
  return readers;
}

TableReader& TableReader::required(std::string_view key, std::string_view example) {
  if (!value_->contains(key)) throw missing(key, example);
  return *this;
}

void TableReader::required_at_end(std::string_view key, std::string_view example) {
  if (!value_->contains(key) && !missing_) missing_ = missing(key, example);
}

IoError TableReader::missing(std::string_view key, std::string_view example) const {
  return {name().empty() ? document_->source_name() : place(),
          fmt::format("found no {}; expected a line such as `{} = {}`", full(key), key, example)};
}

void TableReader::refuse(std::initializer_list<std::string_view> keys, std::string_view condition) {
  for (const std::string_view key : keys)
    if (contains(key)) {
      if (missing_) throw *missing_;  // the missing key may be this condition
      fail(key, fmt::format("is only valid with {}", condition));
    }
}

std::filesystem::path TableReader::resolve(std::string_view key, const std::string& path) const {
  return document_->directory_of(value_or_table(key)) / path;
}

void TableReader::finish() const {
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::string near = document_->suggestion(full(key));
    if (near.empty()) {
      near = nearest_word(key, known_);
      if (!near.empty()) near = full(near);
    }
    throw IoError(document_->place_of_key(value),
                  fmt::format("unknown key {}; {}", full(key),
                              near.empty() ? fmt::format("expected {}", fmt::join(known_, ", "))
                                           : key_suggestion(key, near)));
  }
  if (missing_) throw *missing_;
}

}  // namespace tofsmith
