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

/// What the camera says of a sweep that it took: taps, read-out, range, black level, clipping and
/// exposures.
CorrelationCalibrationOptions sweep_options(const Camera& camera, const DelaySweep& sweep);

/// How much farther a flat target, square to the axis at that distance [m], is in each pixel than
/// on the axis [m] (H, W).
/// @throws std::invalid_argument unless the camera has a lens, which says where pixels look
Image<float> flat_target_geometry_m(double distance_m, const Camera& camera, int height, int width);

/// What the camera says of the noise of frames that it took: bits and the black level,
/// unless dark frames say it.
PhotonTransferOptions noise_options(const Camera& camera, bool has_dark_frames);

/// Whose response was recorded.
enum class ResponseArm {
  light,
  sensor,
  system,  ///< of both arms together: kept in the light's, and the sensor has none
};

/// "light", "sensor", "system". @throws std::invalid_argument for any other word
ResponseArm parse_response_arm(std::string_view word);
/// "file", "hann", "gaussian", "lowpass": the measured response or a fit.
/// @throws std::invalid_argument for any other word
ImpulseResponse::Kind parse_response_kind(std::string_view word);

/// The measured response (kind file) or the fit of that kind.
ImpulseResponse response_of(const CalibratedResponse& found, ImpulseResponse::Kind kind);
/// The camera whose arm responds like that.
Camera with_response(Camera camera, const ImpulseResponse& response, ResponseArm arm);

/// Where the measured response of a camera's file is kept: NAME-response.csv beside NAME.toml.
std::filesystem::path response_path(const std::filesystem::path& camera_path);
/// Writes a measured response beside a camera's file; returns it with that name. A fit is returned
/// as it is. @throws IoError as AtomicFile does
ImpulseResponse write_response_beside(const std::filesystem::path& camera_path,
                                      ImpulseResponse response, OutputPolicy policy);

}  // namespace tofsmith
