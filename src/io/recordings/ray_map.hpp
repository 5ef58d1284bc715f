// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace tofsmith {

/// x/z and y/z of the rays of all pixels, row by row, of an .npy file as DecodeRequest::rays; NaN
/// of pixels that see nothing.
/// @throws IoError if it cannot be read, is of another shape or type, or holds a ray that does not
///         go forward
std::vector<Eigen::Vector2d> read_ray_map(const std::filesystem::path& path, int height, int width);

}  // namespace tofsmith
