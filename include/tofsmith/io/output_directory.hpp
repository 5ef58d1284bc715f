// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tofsmith {

/// Makes a directory for output, with those above it, where it is missing.
/// @throws IoError naming it if it cannot be made, or a file is in the way
void make_output_directory(const std::filesystem::path& directory);

/// Fails if an output is one of the files that the work reads: writing would destroy it.
/// @param inputs  paths, or names that are no files
/// @throws IoError naming the output
void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs);

}  // namespace tofsmith
