// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith {

inline void append_key(std::string& key, const Waveform& waveform) {
  fmt::format_to(std::back_inserter(key), "{}", waveform.level());
  for (const OnInterval& on : waveform.on_intervals())
    fmt::format_to(std::back_inserter(key), ";{}-{}", on.rise, on.fall);
  for (const double sample : waveform.samples())
    fmt::format_to(std::back_inserter(key), ";{}", sample);
}

/// Appends all fields by name, except FieldMark::from_above, as a key of finished work.
template <typename Value>
void append_key(std::string& key, const Value& value) {
  if constexpr (HasFields<const Value>) {
    key += '{';
    for_each_field(value, [&](const auto& field) {
      if (field.is(FieldMark::from_above)) return;
      key += field.name;
      key += '=';
      append_key(key, field.value);
      key += ' ';
    });
    key += '}';
  } else if constexpr (std::is_enum_v<Value>) {
    append_key(key, static_cast<int>(value));
  } else if constexpr (is_optional<Value>) {
    key += value ? '+' : '-';
    if (value) append_key(key, *value);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    fmt::format_to(std::back_inserter(key), "{}", value);
  } else if constexpr (std::is_same_v<Value, std::string>) {
    fmt::format_to(std::back_inserter(key), "{}:{}", value.size(), value);
  } else {
    for (const auto& item : value) {
      append_key(key, item);
      key += ',';
    }
  }
}

}  // namespace tofsmith
