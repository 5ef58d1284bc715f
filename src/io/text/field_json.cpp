// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/field_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "tofsmith/core/error.hpp"
#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

std::string describe(const nlohmann::json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

JsonReader::JsonReader(const nlohmann::json& document, std::string_view file)
    : JsonReader(document, file, "") {}

JsonReader::JsonReader(const nlohmann::json& value, std::string_view file, std::string pointer)
    : value_(&value), file_(file), pointer_(std::move(pointer)) {}

void JsonReader::fail(std::string_view problem) const {
  throw IoError(pointer_.empty() ? std::string(file_) : fmt::format("{}: {}", file_, pointer_),
                problem);
}

void JsonReader::mistyped(std::string_view expected) const {
  fail(fmt::format("found {}; expected {}", describe(*value_), expected));
}

double JsonReader::number() const {
  if (!value_->is_number()) mistyped("a number");
  return value_->get<double>();  // JSON has no infinity, and the parser rejects overflow
}

double JsonReader::number(double low, double high, double tolerance) const {
  const double found = number();
  if (found < low - tolerance || found > high + tolerance)
    mistyped(high == std::numeric_limits<double>::infinity()
                 ? fmt::format("a number >= {}", low)
                 : fmt::format("a number in [{}, {}]", low, high));
  return found;
}

int JsonReader::integer(int low, int high) const {
  const std::string expected = fmt::format("an integer in [{}, {}]", low, high);
  if (!value_->is_number_integer()) mistyped(expected);
  if (value_->is_number_unsigned() && value_->get<std::uint64_t>() > INT32_MAX) mistyped(expected);
  const std::int64_t found = value_->get<std::int64_t>();
  if (found < low || found > high) mistyped(expected);
  return static_cast<int>(found);
}

std::uint64_t JsonReader::unsigned_integer() const {
  if (!value_->is_number_unsigned()) mistyped("an integer in [0, 2^64)");
  return value_->get<std::uint64_t>();
}

bool JsonReader::boolean() const {
  if (!value_->is_boolean()) mistyped("true or false");
  return value_->get<bool>();
}

std::string JsonReader::text() const {
  if (!value_->is_string()) mistyped("a text");
  return value_->get<std::string>();
}

std::vector<JsonReader> JsonReader::elements() const {
  if (!value_->is_array()) mistyped("a list");
  std::vector<JsonReader> all;
  all.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i)
    all.push_back(JsonReader((*value_)[i], file_, fmt::format("{}/{}", pointer_, i)));
  return all;
}

std::vector<JsonReader> JsonReader::elements(std::size_t count, std::string_view because) const {
  if (!value_->is_array() || value_->size() != count)
    mistyped(fmt::format("a list of {}{}{}", count, because.empty() ? "" : ": ", because));
  return elements();
}

void JsonReader::check_object() const {
  if (!value_->is_object()) mistyped("an object");
}

void JsonReader::only(std::initializer_list<std::string_view> members) const {
  check_object();
  for (const auto& [name, ignored] : value_->items()) {
    if (std::find(members.begin(), members.end(), name) != members.end()) continue;
    const std::string near = nearest_word(name, members);
    fail(fmt::format("unknown member \"{}\"; {}", name,
                     near.empty() ? fmt::format("expected {}", fmt::join(members, ", "))
                                  : fmt::format("did you mean \"{}\"?", near)));
  }
}

std::optional<JsonReader> JsonReader::optional_member(std::string_view name) const {
  check_object();
  const auto found = value_->find(std::string(name));
  if (found == value_->end()) return std::nullopt;
  return JsonReader(*found, file_, fmt::format("{}/{}", pointer_, name));
}

JsonReader JsonReader::member(std::string_view name) const {
  if (auto found = optional_member(name)) return *found;
  fail(fmt::format("found no member \"{}\"; expected one", name));
}

namespace {

constexpr std::string_view value_name = "geometric_mean_m";

}  // namespace

nlohmann::ordered_json estimate_json(const Estimate& estimate) {
  return {{value_name, estimate.value}, {error_name(value_name), estimate.standard_error}};
}

namespace detail {

double read_number(const JsonReader& json, const Range& range) {
  if (json.is_null() && range.includes_infinity) return infinity;
  const double found = json.number();
  if (!range.contains(found)) json.mistyped(fmt::format("a number {}", range.text()));
  return found;
}

int read_integer(const JsonReader& json, const Range& range) {
  using Limits = std::numeric_limits<int>;
  const int found = json.integer(Limits::min(), Limits::max());
  if (!range.contains(found)) json.mistyped(fmt::format("an integer {}", range.text(true)));
  return found;
}

void read_estimate(const JsonReader& object, const Field<Estimate>& field) {
  const auto read = [&](const JsonReader& json, std::string_view name) {
    field.value.value = read_number(json.member(name), field.range);
    if (!field.is(FieldMark::without_error))
      field.value.standard_error = read_number(json.member(error_name(name)), field.range);
  };
  if (field.is(FieldMark::as_object))
    read(object.member(field.document_name), value_name);
  else
    read(object, field.document_name);
}

}  // namespace detail

}  // namespace tofsmith
