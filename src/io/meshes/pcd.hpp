// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "tofsmith/io/mesh_file.hpp"

namespace tofsmith {

/// Writes an organized cloud, one point a pixel, row by row, NaN where there is none: PCD 0.7,
/// binary, fields x y z and the scalars, all float32.
/// @param cloud  of height x width points, without colours
/// @throws IoError as AtomicFile
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, int height, int width,
               OutputPolicy policy);

}  // namespace tofsmith
