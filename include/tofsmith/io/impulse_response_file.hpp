// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "tofsmith/camera/impulse_response.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Reads a measured impulse response: text (.csv, .txt) with the columns time_s and value or with
/// values alone, or a one-dimensional NumPy array (.npy). Times must be equally spaced; the first
/// one is when the response starts and is taken for 0.
/// @param time_step_s  needed unless the file has times, with which it must agree
/// @throws IoError naming the file and the place for whatever does not fit
ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> time_step_s = std::nullopt);

/// Writes a response of kind "file" as text with the columns time_s and value, as read above.
/// @throws IoError as AtomicFile does
void write_impulse_response(const std::filesystem::path& path, const ImpulseResponse& response,
                            OutputPolicy policy);

}  // namespace tofsmith
