// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/recordings/decoded_output.hpp"
#include "io/recordings/prepared_frames.hpp"
#include "tofsmith/io/decode_recording.hpp"

namespace tofsmith {

/// Checks everything that needs no file. @throws std::invalid_argument
void check_request(const DecodeRequest& request, const DepthDecoder& decoder);

/// @param source  name of the recording, for errors
/// @throws IoError if the lens is for images of another size, or its distortion folds back inside
///   them
PinholeView view_of_frames(const DecodeRequest& request, const std::string& source, int width,
                           int height);

/// Returns none without distortion, or if not requested.
std::optional<Undistortion> undistortion_of(const DecodeRequest& request, const PinholeView& view);

/// Returns the planes without duplicates.
std::vector<DecodedPlane> planes_to_write(const DecodeRequest& request,
                                          const DepthDecoder& decoder);

std::optional<Filter> filter_of(const DecodeRequest& request, const DecodingTable& table);

/// Exposures of a sliding window; 0 if whole frames are decoded.
int sliding_exposures(const DecodeRequest& request, const DecodingTable& table);

/// @param filter  from filter_of(); must outlive the result
Preparation preparation_of(const DecodeRequest& request, const DecodingTable& table,
                           const std::optional<Filter>& filter);

/// @param source  name of the recording, for errors
/// @throws IoError if maps cannot be read or do not fit, or frames are not of the size of the
///   table's depth correction
PlaneCorrections corrections_of(const DecodeRequest& request, const DecodingTable& table,
                                const std::string& source, int height, int width);

/// Decodes the next band to its position in the planes. Returns false after the last.
bool decode_next(PreparedFrames& input, const PlaneCorrections& corrections, const Band& band,
                 const DecodeTarget& target, DepthImage& planes, const Progress& progress);

}  // namespace tofsmith
