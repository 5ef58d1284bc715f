// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace tofsmith {

/// Limit for codes and tables [bytes].
inline constexpr std::uint64_t max_text_file_bytes = std::uint64_t{1} << 26;
/// Limit for TOML files [bytes].
inline constexpr std::uint64_t max_settings_file_bytes = std::uint64_t{1} << 24;
/// Limit for array or image files that are read as a whole [bytes].
inline constexpr std::uint64_t max_binary_file_bytes = std::uint64_t{1} << 34;

/// Reads a whole file, or at most 256 MB of a pipe or device. Removes the byte order mark of text
/// and converts UTF-16 with such a mark to UTF-8.
/// @throws IoError if it is missing, a directory, unreadable, or larger than `max_bytes`
std::string read_text_file(const std::filesystem::path& path,
                           std::uint64_t max_bytes = max_text_file_bytes);
std::vector<std::byte> read_binary_file(const std::filesystem::path& path,
                                        std::uint64_t max_bytes = max_binary_file_bytes);

/// Includes the dot; "" if there is no extension.
std::string lower_extension(const std::filesystem::path& path);

/// Returns the lower-case extension.
/// @throws IoError naming the file and listing `known`
std::string known_extension(const std::filesystem::path& path,
                            std::initializer_list<std::string_view> known);

}  // namespace tofsmith
