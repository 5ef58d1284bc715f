// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tofsmith {

/// Returns the name of a network file system, such as "NFS", from its number in statfs(); "" for
/// local file systems. Write-ahead logs fail on network file systems, because they require shared
/// memory.
std::string network_file_system(std::uint32_t magic);

/// `path` need not exist.
std::string network_file_system_at(const std::filesystem::path& path);

}  // namespace tofsmith
