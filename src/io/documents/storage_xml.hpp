// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith {

/// Converts OpenCV's FileStorage from XML to YAML: elements with children become maps, or lists if
/// all children are named `_`; elements with several words become lists, with one word scalars.
/// Attributes and comments are omitted. Line numbers are kept.
/// @param name  path, or name for error messages
/// @throws IoError "file:line: ..." if tags do not match
std::string yaml_of_storage_xml(std::string_view text, std::string_view name);

}  // namespace tofsmith
