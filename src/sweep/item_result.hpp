// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tofsmith/code/code_set.hpp"
#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// Returns one line of JSON without the code's name.
/// @param designed  the code, if it was designed for the item
std::string item_result_json(const DepthErrorReport& report, const CodeSet* designed = nullptr);

struct ItemResult {
  DepthErrorReport error;
  std::optional<CodeSet> designed;
};

/// @param code  name of the code
/// @param file  the store, for errors
/// @throws IoError naming file and member
ItemResult parse_item_result(const std::string& json, const std::string& code,
                             std::string_view file);

}  // namespace tofsmith
