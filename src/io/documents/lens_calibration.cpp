// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/shared/lens_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/shared/text_numbers.hpp"
#include "io/documents/calibration_file.hpp"
#include "io/shared/read_file.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

// Spellings of OpenCV and its users, ROS and Kalibr, as letters_and_digits().
using Names = std::initializer_list<std::string_view>;
const Names matrix_names = {"cameramatrix", "intrinsicmatrix", "intrinsics", "intrinsic", "k", "m",
                            "mtx"};
const Names distortion_names = {"distortioncoefficients",
                                "distortioncoeffs",
                                "distortioncoeff",
                                "distcoeffs",
                                "distcoeff",
                                "distortion",
                                "dist",
                                "d"};
const Names width_names = {"imagewidth", "width"};
const Names height_names = {"imageheight", "height"};
const Names size_names = {"imagesize", "resolution", "size"};

struct NamedCamera {
  std::string name;
  CalibrationFile file;
};

std::vector<NamedCamera> cameras_in(const CalibrationFile& file) {
  std::vector<NamedCamera> cameras;
  for (const std::string& name : file.names_in(matrix_names))
    cameras.push_back({name, file.camera(file.root(), name)});
  if (!cameras.empty()) return cameras;
  for (const auto& entry : file.root())
    if (entry.second.IsMap())
      if (const CalibrationFile table = file.camera(entry.second, "");
          !table.names_in(matrix_names).empty())
        cameras.push_back({entry.first.Scalar(), table});
  return cameras;
}

/// @param preferred  camera to use if `name` is empty and the file has several; empty: none
CalibrationFile select_camera(const CalibrationFile& file, std::vector<NamedCamera> cameras,
                              std::string_view name, std::string_view preferred = "") {
  if (name.empty()) name = preferred;
  std::vector<std::string> names;
  for (const NamedCamera& camera : cameras) {
    const bool is_only_one = name.empty() && cameras.size() == 1;
    if (is_only_one || letters_and_digits(camera.name) == letters_and_digits(name))
      return camera.file;
    names.push_back(camera.name);
  }
  if (!name.empty())
    file.fail(fmt::format("found no camera {}; expected {}", name,
                          names == std::vector<std::string>{""}
                              ? "no calibration_camera, as the file has only one camera"
                              : fmt::format("one of {}", fmt::join(names, ", "))));
  file.fail(fmt::format("found cameras {}; expected calibration_camera = \"{}\" or another of them",
                        fmt::join(names, ", "), names.front()));
}

std::optional<int> whole(const CalibrationFile& file, Names names) {
  const YAML::Node node = file.find(names);
  return node ? std::optional(file.whole(node, *names.begin())) : std::nullopt;
}

void check_pinhole(const CalibrationFile& file) {
  if (const YAML::Node node = file.find({"cameramodel"}))
    if (const std::string& word = node.Scalar(); word != "pinhole" && word != "fisheye")
      file.fail(node, fmt::format("camera_model: found {}; expected pinhole; calibrate the camera "
                                  "with that model",
                                  word));
}

/// Nine numbers of a matrix, or Kalibr's fx fy cx cy.
void read_matrix(const CalibrationFile& file, Lens& lens) {
  const YAML::Node node = file.find(matrix_names);
  if (!node) file.fail("found no camera_matrix, or K; expected the nine numbers of a pinhole");
  std::vector<double> k = file.numbers(node, "camera_matrix");
  if (k.size() == 4) k = {k[0], 0.0, k[2], 0.0, k[1], k[3], 0.0, 0.0, 1.0};
  if (k.size() != 9)
    file.fail(node,
              fmt::format("camera_matrix: found {} numbers; expected 9, or fx fy cx cy", k.size()));
  if (!(k[0] > 0.0 && k[4] > 0.0))
    file.fail(node, fmt::format("camera_matrix: found focal lengths {} and {}; expected them > 0",
                                k[0], k[4]));
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    file.fail(node, "camera_matrix: expected [fx 0 cx; 0 fy cy; 0 0 1]: pixels without skew");
  lens.fx_px = k[0], lens.cx_px = k[2], lens.fy_px = k[4], lens.cy_px = k[5];
}

/// Kalibr's radtan is OpenCV's model with four coefficients.
std::optional<DistortionModel> model_of(const CalibrationFile& file) {
  if (const YAML::Node node = file.find({"distortionmodel"})) {
    const std::string word = letters_and_digits(node.Scalar());
    for (const char* same : {"plumbbob", "rationalpolynomial", "opencv", "radtan", "none"})
      if (word == same) return DistortionModel::opencv;
    for (const char* same : {"equidistant", "fisheye", "equi"})
      if (word == same) return DistortionModel::fisheye;
    if (!word.empty())
      file.fail(node, fmt::format("distortion_model: found {}; expected plumb_bob, "
                                  "rational_polynomial, radtan, equidistant, fisheye or none",
                                  node.Scalar()));
  }
  if (const auto is_fisheye = whole(file, {"fisheyemodel"}))
    return *is_fisheye > 0 ? DistortionModel::fisheye : DistortionModel::opencv;
  return std::nullopt;
}

void check(const CalibrationFile& file, const YAML::Node& node, const LensDistortion& distortion) {
  try {
    distortion.validate("distortion_coefficients");
  } catch (const std::invalid_argument& error) {
    file.fail(node, error.what());
  }
}

void read_distortion(const CalibrationFile& file, std::optional<DistortionModel> model,
                     Lens& lens) {
  const YAML::Node node = file.find(distortion_names);
  if (!node) {
    if (const YAML::Node stated = file.find({"distortionmodel"});
        stated && stated.Scalar() == "none")
      return;
    file.fail("found no distortion_coefficients, or D; expected OpenCV's numbers, 0 for none");
  }
  LensDistortion distortion{model_of(file).value_or(model.value_or(DistortionModel::opencv)),
                            file.numbers(node, "distortion_coefficients")};
  const std::vector<double>& c = distortion.coefficients;
  const bool is_none = std::all_of(c.begin(), c.end(), [](double number) { return number == 0.0; });
  if (is_none && distortion.model == DistortionModel::opencv) return;
  check(file, node, distortion);
  lens.distortion = std::move(distortion);
}

/// ROS writes 0 for unknown sizes.
void read_size(const CalibrationFile& file, Lens& lens) {
  lens.width_px = whole(file, width_names);
  lens.height_px = whole(file, height_names);
  const YAML::Node size = file.find(size_names);
  if (size && size.IsSequence() && size.size() == 2) {
    lens.width_px = file.whole(size[0], "image_size");
    lens.height_px = file.whole(size[1], "image_size");
  }
  if (lens.width_px.value_or(0) == 0 || lens.height_px.value_or(0) == 0)
    lens.width_px = lens.height_px = std::nullopt;
}

/// Pixel coordinates refer to whole images.
void check_whole_images(const CalibrationFile& file) {
  for (const char* key : {"binning_x", "binning_y"})
    if (const YAML::Node node = file.find({letters_and_digits(key)});
        node && file.whole(node, key) > 1)
      file.fail(node, fmt::format("{}: expected at most 1: images that are not binned", key));
  const YAML::Node part = file.find({"roi"});
  if (!part || !part.IsMap()) return;
  for (const char* key : {"x_offset", "y_offset"})
    if (const YAML::Node offset = part[key]; offset && file.number(offset, key) != 0.0)
      file.fail(offset, fmt::format("roi.{}: expected 0: images that are not cropped", key));
}

/// Names cameras by the end of their location: D0 (the depth camera) and PV0.
std::vector<NamedCamera> azure_kinect_cameras(const CalibrationFile& file, const YAML::Node& list) {
  std::vector<NamedCamera> cameras;
  for (const YAML::Node& camera : list) {
    if (!camera.IsMap() || !camera["Location"]) continue;
    const std::string place = camera["Location"].Scalar();
    constexpr std::string_view start = "CALIBRATION_CameraLocation";
    cameras.push_back(
        {place.substr(place.starts_with(start) ? start.size() : 0), file.camera(camera, "")});
  }
  return cameras;
}

YAML::Node required(const CalibrationFile& file, const YAML::Node& table, const char* key) {
  if (!table.IsMap() || !table[key])
    file.fail(table, fmt::format("found no {}; expected the calibration of an Azure Kinect", key));
  return table[key];
}

/// Lengths are relative to width and height of the sensor, from its corner.
/// @see Azure Kinect Sensor SDK, src/calibration/calibration.c
Lens read_azure_kinect(const CalibrationFile& file) {
  const YAML::Node intrinsics = required(file, file.root(), "Intrinsics");
  const YAML::Node list = required(file, intrinsics, "ModelParameters");
  const YAML::Node type = required(file, intrinsics, "ModelType");
  const std::vector<double> p = file.numbers(list, "ModelParameters");
  if (p.size() < 14)
    file.fail(list, fmt::format("ModelParameters: found {} numbers; expected 14", p.size()));
  const bool is_brown = type.Scalar().ends_with("BrownConrady");
  if (!is_brown && !type.Scalar().ends_with("Rational6KT"))
    file.fail(type, fmt::format("ModelType: found {}; expected BrownConrady or Rational6KT",
                                type.Scalar()));
  if (p[10] != 0.0 || p[11] != 0.0)
    file.fail(list, fmt::format("ModelParameters: found a centre of distortion of ({}, {}); "
                                "expected (0, 0), the optical axis",
                                p[10], p[11]));
  const int width = file.whole(required(file, file.root(), "SensorWidth"), "SensorWidth");
  const int height = file.whole(required(file, file.root(), "SensorHeight"), "SensorHeight");
  Lens lens{.fx_px = p[2] * width,
            .fy_px = p[3] * height,
            .cx_px = p[0] * width - 0.5,
            .cy_px = p[1] * height - 0.5};
  if (!(lens.fx_px > 0.0 && lens.fy_px > 0.0))
    file.fail(list, fmt::format("ModelParameters: found focal lengths {} and {} px; expected them "
                                "> 0",
                                lens.fx_px, lens.fy_px));
  lens.distortion =
      LensDistortion{is_brown ? DistortionModel::opencv : DistortionModel::rational_6kt,
                     {p[4], p[5], p[13], p[12], p[6], p[7], p[8], p[9]}};
  check(file, list, *lens.distortion);
  const YAML::Node radius = file.find({"metricradius"});
  const double found = radius ? file.number(radius, "MetricRadius") : 0.0;
  constexpr double not_found = 1e-4, default_radius = 1.7;  // as in the SDK
  lens.distortion->max_radius = found > not_found ? found : default_radius;
  if (width == 1024 && height == 1024)
    lens.frame_modes = FrameModes::azure_kinect;
  else
    lens.width_px = width, lens.height_px = height;
  return lens;
}

}  // namespace

Lens parse_lens_calibration(std::string_view text, std::string_view source_name,
                            std::optional<DistortionModel> model, std::string_view camera) {
  const CalibrationFile document(text, source_name);
  if (const YAML::Node device = document.root()["CalibrationInformation"]) {
    const YAML::Node list = required(document, device, "Cameras");
    return read_azure_kinect(
        select_camera(document, azure_kinect_cameras(document, list), camera, "D0"));
  }
  const std::vector<NamedCamera> cameras = cameras_in(document);
  const CalibrationFile file =
      cameras.empty() ? document : select_camera(document, cameras, camera);
  Lens lens;
  check_pinhole(file);
  read_matrix(file, lens);
  read_distortion(file, model, lens);
  check_whole_images(file);
  read_size(file, lens);
  return lens;
}

Lens read_lens_calibration(const std::filesystem::path& path, std::optional<DistortionModel> model,
                           std::string_view camera) {
  return parse_lens_calibration(read_text_file(path, max_settings_file_bytes), path.string(), model,
                                camera);
}

namespace {

/// Returns x/z and y/z of all pixels, row by row; NaN for pixels without a ray.
std::vector<Eigen::Vector2d> read_ray_map(const std::filesystem::path& path, int height,
                                          int width) {
  if (path.extension() != ".npy")
    throw IoError(path.string(), "expected a map of rays as .npy, (H, W, 2) or (H, W, 3)");
  const NpyArray array = read_npy(path);
  const NpyShape& shape = array.shape();
  const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
  if (shape.size() != 3 || shape[0] != rows || shape[1] != columns ||
      (shape[2] != 2 && shape[2] != 3))
    throw IoError(path.string(),
                  fmt::format("found shape ({}); expected ({}, {}, 2), x/z and y/z of each pixel's "
                              "ray, or ({}, {}, 3), its direction",
                              fmt::join(shape, ", "), height, width, height, width));
  const std::vector<double> numbers = array.to_doubles();
  const std::size_t axes = shape[2];
  std::vector<Eigen::Vector2d> slopes(rows * columns);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double* const ray = numbers.data() + i * axes;
    const double z = axes == 3 ? ray[2] : 1.0;
    if (z <= 0.0)
      throw IoError(path.string(), fmt::format("found the ray ({}, {}, {}) of pixel ({}, {}); "
                                               "expected z > 0, or NaN for a pixel without a ray",
                                               ray[0], ray[1], z, i / columns, i % columns));
    slopes[i] = {ray[0] / z, ray[1] / z};
    if (!slopes[i].allFinite()) slopes[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return slopes;
}

}  // namespace

PixelRays rays_of(const std::optional<Lens>& lens, const PinholeView& view) {
  if (!lens || lens->rays.empty()) return PixelRays(view);
  return {view, read_ray_map(lens->rays, view.height, view.width)};
}

}  // namespace tofsmith
