// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "tofsmith/camera/impulse_response.hpp"

namespace tofsmith {

/// Reads a measured impulse response: text (.csv, .txt) with the columns time_s and value or with
/// values alone, or a one-dimensional NumPy array (.npy). Times must be equally spaced.
/// @param time_step_s  needed unless the file has times, with which it must agree
/// @throws IoError naming the file and the place for whatever does not fit
ImpulseResponse read_impulse_response(const std::filesystem::path& path,
                                      std::optional<double> time_step_s = std::nullopt);

}  // namespace tofsmith
