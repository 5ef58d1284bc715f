// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace tofsmith {

/// @param file  what errors call it
/// @throws IoError "file:line:column: .." at the first character that is no JSON
nlohmann::json parse_json(std::string_view text, std::string_view file);

}  // namespace tofsmith
