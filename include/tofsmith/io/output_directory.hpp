// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace tofsmith {

/// Makes a directory for output, with those above it, where it is missing.
/// @throws IoError naming it if it cannot be made, or a file is in the way
void make_output_directory(const std::filesystem::path& directory);

}  // namespace tofsmith
