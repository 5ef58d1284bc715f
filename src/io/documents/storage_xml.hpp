// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tofsmith {

/// Returns an XML document, as OpenCV's FileStorage writes it, as YAML: a map with the root
/// element. An element of elements is a map, or a list if all are named `_`; an element of several
/// words is a list, of one word a scalar. Attributes and comments are left out. Every word stays on
/// its line.
/// @param name  path of the file, or its name in errors
/// @throws IoError "file:line: .." where tags do not match
std::string yaml_of_storage_xml(std::string_view text, std::string_view name);

}  // namespace tofsmith
