// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Writes the table as read_measured_table() reads it: corrfs, corrfs_se, offset_dn and, where they
/// are known, ambient and exposure_s. Columns hold the taps of an exposure side by side.
/// @throws IoError unless the extension is .npz, or as AtomicFile does
void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy);

}  // namespace tofsmith
