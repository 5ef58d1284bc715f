// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// The lens that a calibration found: of OpenCV's FileStorage in YAML (`camera_matrix`,
/// `distortion_coefficients`, `fisheye_model`, `image_width`, `image_height`, as its calibration
/// sample writes them), or of ROS, a camera's file or a camera_info message (`K`, `D`,
/// `distortion_model` plumb_bob, rational_polynomial, equidistant or fisheye, `width`, `height`).
/// A distortion that is 0 throughout is none.
/// @param source_name  path of the file, or what errors shall call it
/// @param model        of files that say none, where four numbers may be either; none: opencv
/// @throws IoError "file:line:column: .." for what is no YAML, what is missing, skewed pixels,
/// tilted
///         sensors, images that are binned or cut, and numbers that are none
Lens parse_lens_calibration(std::string_view text, std::string_view source_name,
                            std::optional<DistortionModel> model = {});
/// The same of a file. @throws IoError, also if it cannot be read
Lens read_lens_calibration(const std::filesystem::path& path,
                           std::optional<DistortionModel> model = {});

}  // namespace tofsmith
