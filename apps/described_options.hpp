// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "number_checks.hpp"
#include "tofsmith/core/fields.hpp"

namespace tofsmith::apps {

namespace detail {
template <typename Value>
struct NumberOf {
  using Type = Value;
};
template <typename Item>
struct NumberOf<std::vector<Item>> {
  using Type = Item;
};
}  // namespace detail

/// Adds the option of one field of a described struct, with its help text, range and default.
/// @param field   its name
/// @param option  such as "--trials"; of a flag that clears it, "!--no-map"
template <typename Options>
CLI::Option* add_field_option(CLI::App& command, Options& options, std::string_view field,
                              const std::string& option) {
  CLI::Option* added = nullptr;
  for_each_field(options, [&](const auto& each) {
    using Value = std::remove_cvref_t<decltype(each.value)>;
    if (each.name != field) return;
    const std::string help(each.help);
    if constexpr (std::is_same_v<Value, bool>) {
      added = command.add_flag(option, each.value, help);
    } else if constexpr (std::is_arithmetic_v<typename detail::NumberOf<Value>::Type>) {
      added = command.add_option(option, each.value, help)->capture_default_str();
      if constexpr (is_list<Value>) added->delimiter(',')->allow_extra_args(false);
      if (each.range.is_restricted)
        added->check(number_that(each.range.text(std::is_integral_v<Value>),
                                 [range = each.range](double v) { return range.contains(v); }));
    }
  });
  TOFSMITH_ASSERT_EQ(added != nullptr, true);  // a field of a type that options support
  return added;
}

}  // namespace tofsmith::apps
