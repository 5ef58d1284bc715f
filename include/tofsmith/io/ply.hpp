// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// One more number per point, such as "intensity" or "confidence".
struct PointScalar {
  std::string name;  ///< letters, digits and underscores
  std::vector<float> values;
};

/// Points in space. Every list but `points_m` may be empty; the others are as long as it.
struct PointCloud {
  std::vector<std::array<float, 3>> points_m;        ///< x, y, z
  std::vector<PointScalar> scalars;                  ///< in the file's order
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< red, green, blue, sRGB
};

/// Reads the vertices of an ascii or binary little endian PLY file that holds nothing else. Scalars
/// of any number type become float.
/// @param file  what errors call it
/// @throws IoError at a byte offset if the header is malformed, x, y or z is missing, there are
///         lists or other elements, or the data is not as long as the header says
PointCloud parse_ply(std::span<const std::byte> content, std::string_view file);
PointCloud read_ply(const std::filesystem::path& path);

/// Binary little endian: x, y, z, the scalars, then red, green, blue.
/// @throws std::invalid_argument if lists differ in length or a scalar's name is no PLY word, taken
///         or used twice
std::vector<std::byte> serialize_ply(const PointCloud& cloud);
/// @throws IoError as AtomicFile does
void write_ply(const std::filesystem::path& path, const PointCloud& cloud, OutputPolicy policy);

}  // namespace tofsmith
