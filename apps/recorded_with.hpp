// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session.hpp"
#include "tap_arguments.hpp"

namespace tofsmith::apps {

/// File in which `simulate` leaves the code of raw frames: raw.code.json next to raw.npy.
std::filesystem::path code_beside(const std::filesystem::path& raw);

/// The code with which frames were recorded: the file next to them.
/// @throws UsageError if there is none
std::string recorded_code(const std::filesystem::path& raw);

/// Warnings that the code and the camera to decode with differ from those next to the raw frames.
std::vector<std::string> recording_conflicts(const std::filesystem::path& raw,
                                             const std::string& code, const Camera& camera,
                                             const CodeFileOptions& file_options);

}  // namespace tofsmith::apps
