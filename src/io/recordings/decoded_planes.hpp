// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "io/recordings/undistortion.hpp"
#include "tofsmith/core/image.hpp"
#include "tofsmith/decode/depth_image.hpp"
#include "tofsmith/scene/scene_image.hpp"

namespace tofsmith {

std::size_t bytes_per_pixel(const std::vector<DecodedPlane>& planes);

/// @param as_z  the depth is z, not radial
void undistort(DepthImage& image, const Undistortion& undistortion, bool as_z);

/// Statuses become their codes.
Image<float> floats_of(const DepthImage& image, DecodedPlane plane);
std::span<const std::byte> items_of(const DepthImage& image, DecodedPlane plane, int rows);

/// Converts radial distance in place.
/// @param depth_m  rows with the width of the view
/// @param first_row  index in the view
void turn_into_z(float* depth_m, int first_row, int rows, const PixelRays& pixel_rays);

}  // namespace tofsmith
