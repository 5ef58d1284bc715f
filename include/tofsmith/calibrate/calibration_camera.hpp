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

/// Returns the options for a sweep recorded by the camera: taps, readout, range, black level,
/// clipping and exposures.
CorrelationCalibrationOptions sweep_options(const Camera& camera, const DelaySweep& sweep);

/// Returns the additional distance of a flat target, perpendicular to the axis at the given
/// distance [m], in each pixel relative to the axis [m] (H, W).
/// @throws std::invalid_argument unless the camera has a lens, which determines the rays
Image<float> flat_target_geometry_m(double distance_m, const Camera& camera, int height, int width);

/// Returns the options for the noise of frames recorded by the camera: bits, and the black level
/// unless there are dark frames.
PhotonTransferOptions noise_options(const Camera& camera, bool has_dark_frames);

/// Arm of a recorded response.
enum class ResponseArm {
  light,
  sensor,
  system,  ///< both arms together: stored as the light's, the sensor has none
};

/// Parses "light", "sensor" or "system". @throws std::invalid_argument for any other word
ResponseArm parse_response_arm(std::string_view word);
/// Parses "file" (the measured response), "hann", "gaussian" or "lowpass" (a fit).
/// @throws std::invalid_argument for any other word
ImpulseResponse::Kind parse_response_kind(std::string_view word);

/// Returns the measured response (kind file) or the fit of a kind.
ImpulseResponse response_of(const CalibratedResponse& found, ImpulseResponse::Kind kind);
/// Returns the camera with an arm's response replaced.
Camera with_response(Camera camera, const ImpulseResponse& response, ResponseArm arm);

/// Returns the path for the measured response of a camera: NAME-response.csv next to NAME.toml.
std::filesystem::path response_path(const std::filesystem::path& camera_path);
/// Writes a measured response to that path and returns it with the file name. A fit is returned
/// unchanged. @throws IoError as AtomicFile
ImpulseResponse write_response_beside(const std::filesystem::path& camera_path,
                                      ImpulseResponse response, OutputPolicy policy);

}  // namespace tofsmith
