// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tofsmith {

/// Returns the name of a file system that other machines can write to, such as "NFS", from its
/// number in statfs(); "" for local file systems. Write-ahead logs require shared memory between
/// their users and therefore fail on network file systems.
std::string network_file_system(std::uint32_t magic);

/// As above, for the location of `path`, which need not exist.
std::string network_file_system_at(const std::filesystem::path& path);

}  // namespace tofsmith
