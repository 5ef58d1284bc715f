// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/toml_value.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace tofsmith {

namespace {

/// JSON's quoting is TOML's for valid text.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string joined(const std::string& list, const std::string& element) {
  return list.empty() ? element : fmt::format("{}, {}", list, element);
}

std::string one_line(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* text = node.as_string()) return quoted(text->get());
  std::string inside;
  if (const auto* list = node.as_array()) {
    for (const toml::node& element : *list) inside = joined(inside, one_line(element));
    return fmt::format("[{}]", inside);
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      const std::string member =
          fmt::format("{} = {}", quoted(std::string(key.str())), one_line(value));
      inside = joined(inside, member);
    }
    return fmt::format("{{ {} }}", inside);
  }
  std::ostringstream out;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) out << value;
  });
  return out.str();
}

}  // namespace

SettingValue toml_value_of(const toml::node& node, std::string place) {
  SettingValue value{one_line(node), {}, {}, std::move(place)};
  value.text = node.is_string() ? node.as_string()->get() : value.toml;
  if (node.is_integer()) value.number = static_cast<double>(node.as_integer()->get());
  if (node.is_floating_point() && std::isfinite(node.as_floating_point()->get()))
    value.number = node.as_floating_point()->get();
  return value;
}

SettingValue toml_value_of(double number, std::string place) {
  const std::string text = fmt::format("{}", number);
  return {text, text, number, std::move(place)};
}

SettingValue toml_value_of_line(const std::string& line, std::string place) {
  double number = 0.0;
  const char* const end = line.data() + line.size();
  const auto [stopped, error] = std::from_chars(line.data(), end, number);
  if (error == std::errc() && stopped == end && std::isfinite(number))
    return {line, line, number, std::move(place)};
  return {line == "true" || line == "false" ? line : quoted(line), line, {}, std::move(place)};
}

}  // namespace tofsmith
