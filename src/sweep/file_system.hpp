// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tofsmith {

/// The name of a file system that other machines may write to as well, such as "NFS", by the number
/// that statfs() gives it; "" for those of this machine alone. Write-ahead logs need shared memory
/// between their users and so break on these.
std::string network_file_system(std::uint32_t magic);

/// The same of where `path` is or would be.
std::string network_file_system_at(const std::filesystem::path& path);

}  // namespace tofsmith
