// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Planes of one size by channel name; usual names are "Z" for depth, "Y" for grey, "R", "G", "B".
using ExrPlanes = std::map<std::string, Image<float>>;

/// Every channel of a flat single-part OpenEXR image, half or float, over its data window.
/// @param file  what errors call it
/// @throws IoError if the file is damaged, deep, of several parts, has integer or subsampled
///         channels or more than 64 of them, or is larger than the limits of image_limits.hpp
ExrPlanes parse_exr(std::span<const std::byte> content, std::string_view file);
ExrPlanes read_exr(const std::filesystem::path& path);

/// Float channels, ZIP compressed.
/// @throws std::invalid_argument if there are no planes, a name is empty, or sizes differ
std::vector<std::byte> serialize_exr(const ExrPlanes& planes);
/// @throws IoError as AtomicFile does
void write_exr(const std::filesystem::path& path, const ExrPlanes& planes, OutputPolicy policy);

}  // namespace tofsmith
