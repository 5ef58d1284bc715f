// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tofsmith/core/image.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/report/figure.hpp"
#include "tofsmith/scene/scene_image.hpp"

// What the figures that show scenes share.
namespace tofsmith {

/// A code's name over a small picture: "redesigned K=4", "sinusoid", "multi-frequency".
std::string short_name(std::string_view code);

/// Images of one size (.., H, W), for an NPZ file.
/// @param axes  what the images stand for, slowest first; its product is their number
NpyArray stack(const NpyShape& axes, const std::vector<Image<float>>& images);

/// The image where `known` is finite, NaN elsewhere.
Image<float> where_known(Image<float> image, const Image<float>& known);

/// Where the pixels that `wanted` names stand: row by row, depth along their rays.
/// @param wanted  (H, W), nonzero = wanted
std::vector<Eigen::Vector3d> points_of(const Image<float>& depth_m, const PinholeView& view,
                                       const Image<std::uint8_t>& wanted);

/// Every pixel with a depth in `shown_m` at its place, coloured by depth; the caption says how many
/// are left out.
Figure cloud_of(FigureText text, const Image<float>& depth_m, const PinholeView& view,
                ValueRange shown_m);

}  // namespace tofsmith
