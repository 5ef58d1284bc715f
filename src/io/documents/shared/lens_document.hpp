// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "io/text/field_json.hpp"
#include "tofsmith/camera/camera.hpp"

namespace tofsmith {

/// Reads the lens of a calibration file:
/// - OpenCV's FileStorage as YAML, XML or JSON: `camera_matrix`, `distortion_coefficients`,
///   `fisheye_model`, `image_width`, `image_height` and other spellings,
/// - ROS, a camera's file or a camera_info message: `K`, `D`, `distortion_model`, ...,
/// - Kalibr's camchain: `intrinsics`, `distortion_coeffs`, `distortion_model`, `resolution`,
/// - the factory calibration of an Azure Kinect (JSON).
///
/// If all distortion coefficients are 0, the lens has no distortion.
/// @param source_name  path, or name for error messages
/// @param model  for files without a model, where four coefficients are ambiguous; none: opencv
/// @param camera  such as "cam1", or "2" for cameraMatrix2; empty: the only one, or the depth
///   camera of an Azure Kinect
/// @throws IoError "file:line:column: ..." for syntax errors, missing values, several cameras,
///   skewed pixels, tilted sensors, other models, and binned or cropped images
Lens parse_lens_calibration(std::string_view text, std::string_view source_name,
                            std::optional<DistortionModel> model = {},
                            std::string_view camera = {});
/// @throws IoError as parse_lens_calibration(), or if the file cannot be read
Lens read_lens_calibration(const std::filesystem::path& path,
                           std::optional<DistortionModel> model = {}, std::string_view camera = {});

/// Uses the keys of a camera file.
nlohmann::ordered_json lens_document(const Lens& lens);

/// Does not check values. @throws IoError naming file and member
Lens lens_from_json(const ValueReader& lens);

}  // namespace tofsmith
