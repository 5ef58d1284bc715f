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

/// Planes of equal size by channel name; usually "Z" for depth, "Y" for grey, "R", "G", "B".
using ExrPlanes = std::map<std::string, Image<float>>;

/// Reads all channels of a flat single-part OpenEXR image, half or float, in its data window.
/// @param file  name for error messages
/// @throws IoError if the file is damaged, deep or multi-part, has integer or subsampled channels
///         or too many of them, or exceeds the limits of image_limits.hpp
ExrPlanes parse_exr(std::span<const std::byte> content, std::string_view file);
ExrPlanes read_exr(const std::filesystem::path& path);

/// Text attribute of an image.
struct ExrText {
  std::string name, text;
};
/// Returns the text of an attribute; "" if the image has none of this name.
/// @throws IoError as parse_exr()
std::string read_exr_text(const std::filesystem::path& path, const std::string& name);

/// Writes float channels with ZIP compression.
/// @param text  written as an attribute unless its name is empty
/// @throws std::invalid_argument if there are no planes, a name is empty, or sizes differ
std::vector<std::byte> serialize_exr(const ExrPlanes& planes, const ExrText& text = {});
/// @throws IoError as AtomicFile
void write_exr(const std::filesystem::path& path, const ExrPlanes& planes, OutputPolicy policy,
               const ExrText& text = {});

}  // namespace tofsmith
