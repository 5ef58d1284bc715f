// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/document_text.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace tofsmith {
namespace {

using Json = nlohmann::ordered_json;

std::string plain(const Json& value) {
  try {
    return value.dump();
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("cannot be written: {}", error.what()));
  }
}

std::string one_line(const Json& value) {
  if (!value.is_structured()) return plain(value);
  std::string text;
  for (const auto& [key, member] : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += plain(key) + ": ";
    text += one_line(member);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

bool holds_objects(const Json& list) {
  return list.is_array() && !list.empty() && list[0].is_object();
}

std::string indented(const Json& value, const std::string& indent) {
  const bool list = holds_objects(value);
  if (!list && (!value.is_object() || value.empty())) return one_line(value);
  const std::string inner = indent + "  ";
  std::string text;
  for (const auto& [key, member] : value.items()) {
    text += text.empty() ? "\n" : ",\n";
    text += inner;
    text += list ? one_line(member) : plain(key) + ": " + indented(member, inner);
  }
  return fmt::format("{}{}\n{}{}", list ? '[' : '{', text, indent, list ? ']' : '}');
}

/// A value to the right of "key =". JSON's numbers, texts and lists of them are TOML's, but for
/// the DEL character.
std::string toml_value(const Json& value) {
  if (value.is_object()) {
    std::string text;
    for (const auto& [key, member] : value.items())
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, toml_value(member));
    return "{ " + text + " }";
  }
  std::string text = one_line(value);
  for (std::size_t at; (at = text.find('\x7f')) != std::string::npos;)
    text.replace(at, 1, "\\u007f");
  return text;
}

}  // namespace

std::string format_json(const Json& document) { return indented(document, ""); }

std::string format_toml(const Json& document) {
  std::string values, sections;
  for (const auto& [key, value] : document.items()) {
    if (!value.is_object()) {
      values += fmt::format("{} = {}\n", key, toml_value(value));
      continue;
    }
    sections += fmt::format("\n[{}]\n", key);
    for (const auto& [inner_key, member] : value.items())
      sections += fmt::format("{} = {}\n", inner_key, toml_value(member));
  }
  return values + sections;
}

}  // namespace tofsmith
