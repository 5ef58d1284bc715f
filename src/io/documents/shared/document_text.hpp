// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace tofsmith {

/// @param file  what errors call it
/// @throws IoError "file:line:column: .." at the first character that is no JSON
nlohmann::json parse_json(std::string_view text, std::string_view file);

/// JSON for people to read: one member a line, while lists of plain values and what stands in
/// lists stay on one line. Numbers read back as exactly what they were.
/// @throws std::invalid_argument if a text is not UTF-8
std::string format_json(const nlohmann::ordered_json& document);

/// A document of tables as TOML: plain values first, then one section for each table; tables in
/// tables are written in braces.
/// @throws std::invalid_argument if a text is not UTF-8
std::string format_toml(const nlohmann::ordered_json& document);

}  // namespace tofsmith
