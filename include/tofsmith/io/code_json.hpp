// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tofsmith/code/code_set.hpp"

namespace tofsmith {

/// The code as a JSON document: binary waveforms by their switching times on the unit period,
/// others by their samples; numbers read back as exactly what they were.
/// @throws std::invalid_argument if a text is not UTF-8 or the provenance is not finite
std::string code_to_json(const CodeSet& code);

/// @param file  what errors call it
/// @throws IoError "file:line:column: .." where it is no JSON, else "file: /json/pointer: .." for
///         members that are missing, unknown or of the wrong type, lengths that disagree, and
///         values that no code can have
CodeSet parse_code_json(std::string_view text, std::string_view file = "code.json");

}  // namespace tofsmith
