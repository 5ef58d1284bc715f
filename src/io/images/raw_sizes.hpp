// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Checks type and shape, and returns the sizes without values.
/// @throws IoError if the type or shape is not one of raw frames, or K differs from the code's
RawFrames checked_raw_sizes(NpyType type, const NpyShape& shape, const RawReadOptions& options,
                            const std::string& file);

/// @throws IoError if the measurements of a dump differ from the code's
void check_measurements(const RawFormat& format, int expected, const std::string& file);

bool is_unsigned(NpyType type);

/// @throws IoError if the file's type cannot represent a marker
void check_markers(const RawMarkers& markers, NpyType type, const std::string& file);
void check_markers(const RawMarkers& markers, const RawFormat& format, const std::string& file);

}  // namespace tofsmith
