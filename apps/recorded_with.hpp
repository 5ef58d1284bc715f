// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session.hpp"
#include "tap_arguments.hpp"

namespace tofsmith::apps {

/// Returns the file in which `simulate` stores the code of raw frames: raw.code.json for raw.npy.
std::filesystem::path code_beside(const std::filesystem::path& raw);

/// Returns the file next to raw frames with the code that recorded them.
/// @throws UsageError if there is none
std::string recorded_code(const std::filesystem::path& raw);

/// Returns warnings if the code or the camera for decoding differs from the file next to the raw
/// frames.
std::vector<std::string> recording_conflicts(const std::filesystem::path& raw,
                                             const std::string& code, const Camera& camera,
                                             const CodeFileOptions& file_options);

}  // namespace tofsmith::apps
