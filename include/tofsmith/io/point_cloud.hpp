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

/// Number per point, such as "intensity".
struct PointScalar {
  std::string name;  ///< letters, digits and underscores
  std::vector<float> values;
};

/// Points in space. Lists other than `points_m` are empty or of the same length.
struct PointCloud {
  std::vector<std::array<float, 3>> points_m;  ///< x, y, z
  std::vector<PointScalar> scalars;
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< sRGB
};

/// Writes binary little-endian PLY: x, y, z, the scalars, then red, green, blue.
/// @throws std::invalid_argument if lists differ in length or a scalar's name is invalid, reserved
///         or occurs twice
std::vector<std::byte> serialize_ply(const PointCloud& cloud);
void write_ply(const std::filesystem::path& path, const PointCloud& cloud, OutputPolicy policy);

/// Writes an organized cloud as binary PCD 0.7 with fields x, y, z and the scalars, all float32.
/// @param cloud  one point per pixel without colours, row by row; NaN: no point
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, int height, int width,
               OutputPolicy policy);

}  // namespace tofsmith
