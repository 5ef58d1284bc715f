// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Additional number per point, such as "intensity" or "confidence".
struct PointScalar {
  std::string name;  ///< letters, digits and underscores
  std::vector<float> values;
};

/// Points in space. Lists other than `points_m` are empty or of the same length.
struct PointCloud {
  std::vector<std::array<float, 3>> points_m;        ///< x, y, z
  std::vector<PointScalar> scalars;                  ///< in the file's order
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< red, green, blue, sRGB
};

/// Writes binary little-endian PLY: x, y, z, the scalars, then red, green, blue.
/// @throws std::invalid_argument if lists differ in length or a scalar's name is not a valid PLY
///         word, is reserved or occurs twice
std::vector<std::byte> serialize_ply(const PointCloud& cloud);
/// @throws IoError as AtomicFile
void write_ply(const std::filesystem::path& path, const PointCloud& cloud, OutputPolicy policy);

/// Writes an organized cloud with one point per pixel, row by row, NaN for pixels without a point,
/// as PCD 0.7, binary, with fields x, y, z and the scalars, all float32.
/// @param cloud  height x width points, without colours
/// @throws IoError as AtomicFile
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, int height, int width,
               OutputPolicy policy);

}  // namespace tofsmith
