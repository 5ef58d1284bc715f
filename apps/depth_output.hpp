// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "session.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/scene/pinhole.hpp"

namespace tofsmith::apps {

/// Names of the planes a decoder gives: depth, signal, ambient, confidence, deviation, status.
std::vector<std::string> plane_names();

/// Writes what a decoder gave by extension: .npy, .pfm and .png hold depth; .exr every chosen plane
/// as a channel; .npz every chosen plane as an array; .ply a point cloud with the chosen planes as
/// scalars.
/// @param planes  of plane_names()
/// @throws IoError for an unknown extension, naming the known ones
void write_decoded(const std::filesystem::path& path, const DepthImage& image,
                   const std::vector<std::string>& planes, const PinholeView& view,
                   OutputPolicy policy);

/// Fails before the work if write_decoded() could not write there.
/// @throws IoError
void check_decoded_output(const std::filesystem::path& path, const Session& session);

/// "ok 76.1 %, low_signal 3.2 %, .."
std::string status_summary(const DepthImage& image);

}  // namespace tofsmith::apps
