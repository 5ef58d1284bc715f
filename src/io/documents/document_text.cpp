// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/shared/document_text.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <stdexcept>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// Returns "file:line:column", counted from 1.
std::string place_of(std::string_view text, std::size_t byte, std::string_view file) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("{}:{}:{}", file, line, before.size() - line_start + 1);
}

std::string_view problem_of(std::string_view message) {
  const std::size_t place = message.find("column ");
  const std::size_t colon = place == std::string_view::npos ? place : message.find(": ", place);
  return colon == std::string_view::npos ? message : message.substr(colon + 2);
}

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

/// Formats the right side of "key =". Numbers, strings and lists in JSON are valid TOML, except for
/// DEL.
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

Document parse_json(std::string_view text, std::string_view file) {
  constexpr int deepest = 64;
  const auto check_depth = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > deepest)
      throw IoError(file, fmt::format("found lists within lists more than {} deep; expected a "
                                      "document",
                                      deepest));
    return true;
  };
  // The parser would end at a zero byte.
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    throw IoError(place_of(text, zero, file), "found a zero byte; expected a JSON document");
  try {
    return {nlohmann::json::parse(text, check_depth), file, Syntax::json};
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    throw IoError(place_of(text, byte, file), problem_of(error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw IoError(file, error.what());  // e.g. a number out of range
  }
}

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
