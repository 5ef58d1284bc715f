// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

/// Sizes without values, after everything about the array has been checked.
/// @throws IoError if the type or the shape is none of raw frames, or K is not what is asked for
RawFrames checked_raw_sizes(NpyType type, const NpyShape& shape, const RawReadOptions& options,
                            const std::string& file);

/// @throws IoError if a dump does not have the measurements that the code takes
void check_measurements(const RawFormat& format, int expected, const std::string& file);

/// Returns true for types of whole numbers >= 0.
bool is_unsigned(NpyType type);

/// @throws IoError if a marker is no number of the file's type
void check_markers(const RawMarkers& markers, NpyType type, const std::string& file);
/// @throws IoError if a marker is no number of the dump's format
void check_markers(const RawMarkers& markers, const RawFormat& format, const std::string& file);

}  // namespace tofsmith
