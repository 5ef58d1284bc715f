// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "decoded_planes.hpp"
#include "session.hpp"
#include "tofsmith/scene/pinhole.hpp"

namespace tofsmith::apps {

/// Writes what a decoder gave by extension: .npy, .pfm and .png hold depth; .exr every chosen plane
/// as a channel; .npz every chosen plane as an array; .ply a point cloud with the chosen planes as
/// scalars.
/// @param planes  those of `decoded` to write; .npy, .pfm and .png take depth, .ply needs it too
/// @throws IoError for an unknown extension, naming the known ones
void write_decoded(const std::filesystem::path& path, const DecodedPlanes& decoded,
                   const std::vector<std::string>& planes, const PinholeView& view,
                   OutputPolicy policy);

/// Fails before the work if write_decoded() could not write there.
/// @throws IoError
void check_decoded_output(const std::filesystem::path& path, const Session& session);

/// Memory that write_decoded() takes for a while, beside the planes themselves [bytes per pixel];
/// for all formats but .npy at most this much.
std::size_t writing_bytes_per_pixel(std::string_view extension,
                                    const std::vector<std::string>& planes);

}  // namespace tofsmith::apps
