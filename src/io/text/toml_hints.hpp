// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tofsmith {

/// The likely cause of a syntax error in a line of TOML, as "; ...": a binary file, a decimal
/// comma, a unit or a word without quotes. "" if there is none.
std::string toml_hint(std::string_view text, std::size_t line);

/// `key = word` as `key = "word"`; none if the value is not a single word or number with a unit.
std::optional<std::string> with_quotes(const std::string& setting);

/// The suggestion of a known key for an unknown one, with its unit if the two keys have different
/// units; "" if no key is near.
std::string key_suggestion(std::string_view unknown, std::string_view near);

}  // namespace tofsmith
