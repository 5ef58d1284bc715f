// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tofsmith {

/// Returns the likely cause of a syntax error, as "; ...": a binary file, a decimal comma, or a
/// unit or a word without quotes; "" if unknown.
std::string toml_hint(std::string_view text, std::size_t line);

/// Returns `key = "word"` for `key = word`; none if the value is not a single word or number with a
/// unit.
std::optional<std::string> with_quotes(const std::string& setting);

/// Suggests a known key, with its unit if the two keys have different units.
std::string key_suggestion(std::string_view unknown, std::string_view near);

}  // namespace tofsmith
