// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

namespace tofsmith {

/// The extension in lower case, with its dot; "" without one.
std::string lower_extension(const std::filesystem::path& path);

/// The same, when it is one of `known`.
/// @throws IoError that names the file and lists `known`
std::string known_extension(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> known);

}  // namespace tofsmith
