// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// Whole numbers that nothing was said about.
std::optional<std::string> electrons_note(const RawFramesReader& reader,
                                          const DecodingTable& table);
/// Warning if both the table and the pixels' offsets contain a constant, which may be the same
/// constant.
std::optional<std::string> repeated_offset_note(const DecodingTable& table,
                                                const Image<float>& offset_m);
/// Where no pixel of any frame has a depth: how many have which status, and what to look at.
std::optional<std::string> no_depth_note(const StatusCounts& statuses);
/// Warning if more than 10 % of the pixels of all frames are inconsistent, with likely causes.
std::optional<std::string> inconsistent_note(const StatusCounts& statuses);
/// Warning if the noise of a filtered frame is more than 1.5 times the prediction of the camera, or
/// less than 1 / 1.5 of it.
/// @param ratio     of the standard deviations
/// @param averaged  DecodeRequest::averaged
std::optional<std::string> noise_note(double ratio, int frame, double averaged);

}  // namespace tofsmith
