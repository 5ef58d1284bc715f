// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/calibrate/calibration_camera.hpp"

#include <cmath>

#include "io/arrays/shared/array_matrix.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/calibrate/correlation_calibration.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/measured_table_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

namespace {

/// T [s] of every column (K); empty if all exposures are equal.
Eigen::VectorXd column_exposures_s(const Camera& camera, int columns, int columns_per_exposure) {
  Eigen::VectorXd exposure_s;
  if (camera.exposure_s.each_s.empty()) return exposure_s;
  exposure_s.resize(columns);
  for (int k = 0; k < columns; ++k)
    exposure_s[k] = camera.exposure_s.of(k / columns_per_exposure, columns / columns_per_exposure);
  return exposure_s;
}

}  // namespace

CorrelationCalibrationOptions sweep_options(const Camera& camera, const DelaySweep& sweep) {
  CorrelationCalibrationOptions options{.taps = camera.sensor.taps,
                                        .differences = camera.sensor.subtracts(),
                                        .range_m = camera.range_m()};
  if (camera.sensor.is_signed() || !options.differences)
    options.black_level = camera.sensor.black_level_dn.value_or(0.0);
  if (!options.differences && camera.sensor.adc_bits)
    options.saturation_level = static_cast<float>(std::exp2(*camera.sensor.adc_bits) - 1.0);
  options.exposure_s =
      column_exposures_s(camera, sweep.frames.measurements, options.differences ? 1 : options.taps);
  return options;
}

Image<float> flat_target_geometry_m(double distance_m, const Camera& camera, int height,
                                    int width) {
  require(camera.lens.has_value(), "target_distance_m", distance_m,
          "requires the camera's [lens], which defines the ray of each pixel");
  const PixelRays rays = rays_of(camera.lens, view_of(camera.lens, width, height));
  Image<float> geometry_m(height, width);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      geometry_m(row, column) =
          static_cast<float>(distance_m * (rays.radial_per_z(row, column) - 1.0));
  return geometry_m;
}

PhotonTransferOptions noise_options(const Camera& camera, bool has_dark_frames) {
  require(
      !camera.sensor.is_signed(), "sensor.demodulation", "signed",
      "must be \"gain\" to calibrate noise: the mean of a mixer does not determine its shot noise");
  PhotonTransferOptions options{.adc_bits = camera.sensor.adc_bits};
  if (!has_dark_frames || camera.sensor.readout == Readout::difference)
    options.black_level_dn = camera.sensor.black_level_dn;
  return options;
}

ImpulseResponse::Kind parse_response_kind(std::string_view word) {
  using Kind = ImpulseResponse::Kind;
  for (const Kind kind : {Kind::file, Kind::hann, Kind::gaussian, Kind::lowpass})
    if (word == name_of(kind)) return kind;
  reject("kind", word, "must be file, hann, gaussian or lowpass");
}

ImpulseResponse response_of(const CalibratedResponse& found, ImpulseResponse::Kind kind) {
  for (const ParametricResponse& fit : found.fits)
    if (fit.response.kind == kind) return fit.response;
  return found.response;
}

Camera with_response(Camera camera, const ImpulseResponse& response, ResponseArm arm) {
  if (arm == ResponseArm::sensor) {
    camera.sensor.impulse_response = response;
    return camera;
  }
  camera.light.impulse_response = response;
  if (arm == ResponseArm::system) camera.sensor.impulse_response = {};
  return camera;
}

std::filesystem::path response_path(const std::filesystem::path& camera_path) {
  std::filesystem::path path = camera_path;
  return path.replace_filename(camera_path.stem().string() + "-response.csv");
}

ImpulseResponse write_response_beside(const std::filesystem::path& camera_path,
                                      ImpulseResponse response, OutputPolicy policy) {
  if (response.kind != ImpulseResponse::Kind::file) return response;
  const std::filesystem::path path = response_path(camera_path);
  write_impulse_response(path, response, policy);
  response.file = path.filename().string();
  return response;
}

namespace {

NpyArray list_of(const Eigen::VectorXd& values) {
  return NpyArray::of<double>(
      {static_cast<std::size_t>(values.size())},
      std::span<const double>(values.data(), static_cast<std::size_t>(values.size())));
}

NpzArrays arrays_of(const MeasuredTable& table) {
  NpzArrays arrays;
  arrays.emplace("corrfs", array_of(table.correlation));
  arrays.emplace("taps", NpyArray::of<double>({}, std::vector{static_cast<double>(table.taps)}));
  arrays.emplace("differences",
                 NpyArray::of<double>({}, std::vector{table.differences ? 1.0 : 0.0}));
  arrays.emplace("model_error_percent",
                 NpyArray::of<double>({}, std::vector{table.model_error_percent}));
  if (table.black_level.size() > 0) arrays.emplace("offset_dn", list_of(table.black_level));
  if (table.ambient_gain.size() > 0) arrays.emplace("ambient", list_of(table.ambient_gain));
  if (table.exposure_s.size() > 0) arrays.emplace("exposure_s", list_of(table.exposure_s));
  if (table.correction) add_correction(*table.correction, arrays);
  return arrays;
}

}  // namespace

void write_calibrated_table(const std::filesystem::path& path, const MeasuredTable& table,
                            OutputPolicy policy) {
  known_extension(path, {".npz"});
  write_npz(path, arrays_of(table), policy);
}

void write_calibrated_table(const std::filesystem::path& path, const CalibratedCorrelation& found,
                            OutputPolicy policy) {
  known_extension(path, {".npz"});
  NpzArrays arrays = arrays_of(found.table);
  arrays.emplace("corrfs_se", array_of(found.standard_error));
  write_npz(path, arrays, policy);
}

}  // namespace tofsmith
