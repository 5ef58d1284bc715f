// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tofsmith {

/// Codes and tables are far below this [bytes].
inline constexpr std::uint64_t max_text_file_bytes = std::uint64_t{1} << 26;
/// So are TOML files below this one.
inline constexpr std::uint64_t max_settings_file_bytes = std::uint64_t{1} << 24;
/// Most that one array or image file may hold when it is read as a whole [bytes].
inline constexpr std::uint64_t max_binary_file_bytes = std::uint64_t{1} << 34;

/// The whole content of a file (or of a pipe or device, up to its end and 256 MB at most).
/// A text loses its byte order mark, and becomes UTF-8 if that mark is of UTF-16.
/// @throws IoError if it is missing, a directory, unreadable, or larger than `max_bytes`
std::string read_text_file(const std::filesystem::path& path,
                           std::uint64_t max_bytes = max_text_file_bytes);
std::vector<std::byte> read_binary_file(const std::filesystem::path& path,
                                        std::uint64_t max_bytes = max_binary_file_bytes);

}  // namespace tofsmith
