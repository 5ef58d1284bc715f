// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace tofsmith {

/// @throws IoError "file:line:column: ..." at the first syntax error
nlohmann::json parse_json(std::string_view text, std::string_view file);

/// Formats one member per line; lists of plain values, and elements of lists, are on one line.
/// Numbers are read back exactly.
/// @throws std::invalid_argument if a text is not UTF-8
std::string format_json(const nlohmann::ordered_json& document);

/// Formats plain values first, then one section per table; nested tables are in braces.
/// @throws std::invalid_argument if a text is not UTF-8
std::string format_toml(const nlohmann::ordered_json& document);

}  // namespace tofsmith
