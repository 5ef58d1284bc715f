// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/calibrate/impulse_response.hpp"
#include "tofsmith/calibrate/photon_transfer.hpp"
#include "tofsmith/io/atomic_file.hpp"

namespace tofsmith {

/// Returns the options for a sweep that follow from its camera.
CorrelationCalibrationOptions sweep_options(const Camera& camera, const DelaySweep& sweep);

/// Returns the distance of each pixel to a flat target perpendicular to the axis, minus
/// `distance_m` [m] (H, W).
/// @throws std::invalid_argument unless the camera has a lens
Image<float> flat_target_geometry_m(double distance_m, const Camera& camera, int height, int width);

/// Returns the options for frames of the camera: bits, and the black level unless there are dark
/// frames.
PhotonTransferOptions noise_options(const Camera& camera, bool has_dark_frames);

/// Arm of a recorded response.
enum class ResponseArm {
  light,
  sensor,
  system,  ///< both arms together, stored as the response of the light
};

constexpr auto words_of(ResponseArm /*any*/) { return word_list("light", "sensor", "system"); }
/// @throws InvalidArgument for other words
inline ResponseArm parse_response_arm(std::string_view word) {
  return parse_word<ResponseArm>("arm", word);
}
/// Parses "file" (the measured response), "hann", "gaussian" or "lowpass" (a fit).
/// @throws InvalidArgument for other words
ImpulseResponse::Kind parse_response_kind(std::string_view word);

/// Returns the measured response (kind file) or the fit of a kind.
ImpulseResponse response_of(const CalibratedResponse& found, ImpulseResponse::Kind kind);
/// Returns the camera with an arm's response replaced.
Camera with_response(Camera camera, const ImpulseResponse& response, ResponseArm arm);

/// Returns NAME-response.csv next to the camera file NAME.toml.
std::filesystem::path response_path(const std::filesystem::path& camera_path);
/// Writes a measured response to response_path() and returns it with the file name. Returns a fit
/// unchanged.
/// @throws IoError as AtomicFile
ImpulseResponse write_response_beside(const std::filesystem::path& camera_path,
                                      ImpulseResponse response, OutputPolicy policy);

}  // namespace tofsmith
