// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tofsmith {

/// Maximum size of codes and tables [bytes].
inline constexpr std::uint64_t max_text_file_bytes = std::uint64_t{1} << 26;
/// Maximum size of TOML files [bytes].
inline constexpr std::uint64_t max_settings_file_bytes = std::uint64_t{1} << 24;
/// Maximum size of an array or image file that is read as a whole [bytes].
inline constexpr std::uint64_t max_binary_file_bytes = std::uint64_t{1} << 34;

/// Reads a whole file, or a pipe or device up to its end and at most 256 MB. For text, the byte
/// order mark is removed, and UTF-16 with such a mark is converted to UTF-8.
/// @throws IoError if it is missing, a directory, unreadable, or larger than `max_bytes`
std::string read_text_file(const std::filesystem::path& path,
                           std::uint64_t max_bytes = max_text_file_bytes);
std::vector<std::byte> read_binary_file(const std::filesystem::path& path,
                                        std::uint64_t max_bytes = max_binary_file_bytes);

}  // namespace tofsmith
