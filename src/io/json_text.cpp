// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tofsmith/core/error.hpp"

namespace tofsmith {
namespace {

/// "file:line:column", both counted from 1, of a byte counted from 0.
std::string place_of(std::string_view text, std::size_t byte, std::string_view file) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("{}:{}:{}", file, line, before.size() - line_start + 1);
}

/// The library's message without its own code and place, which ours replaces.
std::string_view problem_of(std::string_view message) {
  const std::size_t place = message.find("column ");
  const std::size_t colon = place == std::string_view::npos ? place : message.find(": ", place);
  return colon == std::string_view::npos ? message : message.substr(colon + 2);
}

}  // namespace

nlohmann::json parse_json(std::string_view text, std::string_view file) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    throw IoError(place_of(text, byte, file), problem_of(error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw IoError(file, error.what());  // such as a number out of range
  }
}

}  // namespace tofsmith
