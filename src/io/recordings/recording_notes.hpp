// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// Note if raw numbers are integers, but the camera has no gain, black level or saturation.
std::optional<std::string> electrons_note(const RawFramesReader& reader,
                                          const DecodingTable& table);
/// Warning if both the table and the pixels' offsets contain a constant, which may be the same
/// constant.
std::optional<std::string> repeated_offset_note(const DecodingTable& table,
                                                const Image<float>& offset_m);
/// Note if the offset of a pixel exceeds the unambiguous range: its unit may not be metres.
std::optional<std::string> large_offset_note(const DecodingTable& table,
                                             const Image<float>& offset_m);
/// Note if no pixel of any frame has a depth.
std::optional<std::string> no_depth_note(const StatusCounts& statuses);
/// Warning if more than 10 % of the pixels of all frames are inconsistent.
std::optional<std::string> inconsistent_note(const StatusCounts& statuses);
/// Warning if the noise of a filtered frame differs from the prediction of the camera by a factor
/// above 1.5.
/// @param ratio  measured divided by predicted standard deviation
/// @param averaged  DecodeRequest::averaged
std::optional<std::string> noise_note(double ratio, int frame, double averaged);

}  // namespace tofsmith
