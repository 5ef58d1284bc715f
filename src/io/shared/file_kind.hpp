// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace tofsmith {

/// Includes the dot; "" if there is no extension.
std::string lower_extension(const std::filesystem::path& path);

/// Returns the lower-case extension.
/// @throws IoError naming the file and listing `known`
std::string known_extension(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> known);

}  // namespace tofsmith
