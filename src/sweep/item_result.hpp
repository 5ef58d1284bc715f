// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "tofsmith/simulate/depth_error.hpp"

namespace tofsmith {

/// A depth error as a store holds it: one line of JSON, without the code's name, which does not
/// determine it.
std::string item_result_json(const DepthErrorReport& report);

/// The same back.
/// @param code  the name
/// @param file  the store, for errors
/// @throws IoError naming file and member
DepthErrorReport parse_item_result(const std::string& json, const std::string& code,
                                   std::string_view file);

}  // namespace tofsmith
