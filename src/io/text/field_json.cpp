// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/text/field_json.hpp"

#include <fmt/format.h>

#include "tofsmith/core/units.hpp"

namespace tofsmith {

namespace {

constexpr std::string_view value_name = "geometric_mean_m";

}  // namespace

nlohmann::ordered_json estimate_json(const Estimate& estimate) {
  return {{value_name, estimate.value}, {error_name(value_name), estimate.standard_error}};
}

namespace detail {

double read_number(const ValueReader& json, const Range& range) {
  if (json.is_null() && range.includes_infinity) return infinity;
  const double found = json.number();
  if (!range.contains(found)) json.mistyped(fmt::format("a number {}", range.text()));
  return found;
}

int read_integer(const ValueReader& json, const Range& range) {
  const int found = json.integer();
  if (!range.contains(found)) json.mistyped(fmt::format("an integer {}", range.text(true)));
  return found;
}

void read_estimate(const ValueReader& object, const Field<Estimate>& field) {
  const auto read = [&](const ValueReader& json, std::string_view name) {
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
