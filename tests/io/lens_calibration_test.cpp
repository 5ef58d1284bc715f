// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/shared/lens_document.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {
namespace {

/// In the format of cv::FileStorage and OpenCV's calibration sample.
const std::string opencv_yaml = R"(%YAML:1.0
---
calibration_time: "Mon Nov 23 10:00:00 2026"
image_width: 640
image_height: 480
fisheye_model: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.2581e+02, 0., 3.1925e+02, 0., 5.2453e+02, 2.4112e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -2.8e-01, 9.5e-02, 1.2e-03, -4.0e-04, -1.1e-02 ]
)";

/// A printed camera_info message.
const std::string ros_message = R"(header:
  seq: 0
  frame_id: tof
height: 240
width: 320
distortion_model: rational_polynomial
D: [0.42, -2.6, 0.0006, -0.0002, 1.5, 0.31, -2.4, 1.42]
K: [225.0, 0.0, 160.5, 0.0, 226.0, 118.0, 0.0, 0.0, 1.0]
R: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
P: [225.0, 0.0, 160.5, 0.0, 0.0, 226.0, 118.0, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
binning_y: 0
roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}
)";

/// A camera file written by ROS's camera_calibration.
const std::string ros_file = R"(image_width: 320
image_height: 240
camera_name: tof
camera_matrix:
  rows: 3
  cols: 3
  data: [225, 0, 160.5, 0, 226, 118, 0, 0, 1]
distortion_model: equidistant
distortion_coefficients:
  rows: 1
  cols: 4
  data: [0.05, -0.01, 0.004, -0.001]
)";

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  return text.replace(text.find(old), old.size(), fresh);
}

TEST(LensCalibration, ReadsOpenCvFiles) {
  const Lens expected{
      .fx_px = 525.81,
      .fy_px = 524.53,
      .cx_px = 319.25,
      .cy_px = 241.12,
      .distortion = LensDistortion{DistortionModel::opencv, {-0.28, 0.095, 1.2e-3, -4e-4, -0.011}},
      .width_px = 640,
      .height_px = 480};
  EXPECT_EQ(parse_lens_calibration(opencv_yaml, "a.yml"), expected);
}

TEST(LensCalibration, ReadsRosFiles) {
  const Lens message = parse_lens_calibration(ros_message, "a.yaml");
  EXPECT_EQ(message.fy_px, 226.0);
  EXPECT_EQ(message.width_px, 320);
  EXPECT_EQ(message.distortion,
            (LensDistortion{DistortionModel::opencv,
                            {0.42, -2.6, 0.0006, -0.0002, 1.5, 0.31, -2.4, 1.42}}));
  const Lens file = parse_lens_calibration(ros_file, "a.yaml");
  EXPECT_EQ(file.cx_px, 160.5);
  EXPECT_EQ(file.distortion,
            (LensDistortion{DistortionModel::fisheye, {0.05, -0.01, 0.004, -0.001}}));
}

TEST(LensCalibration, FourCoefficientsAreFisheyeIfTheFileOrTheCameraSpecifiesIt) {
  const std::string plain = with(ros_file, "distortion_model: equidistant\n", "");
  using enum DistortionModel;
  EXPECT_EQ(parse_lens_calibration(plain, "a").distortion->model, opencv);
  EXPECT_EQ(parse_lens_calibration(plain, "a", fisheye).distortion->model, fisheye);
  EXPECT_EQ(parse_lens_calibration(plain + "fisheye_model: 1\n", "a").distortion->model, fisheye);
}

TEST(LensCalibration, ZeroDistortionIsNone) {
  EXPECT_FALSE(parse_lens_calibration(
                   with(ros_message, "[0.42, -2.6, 0.0006, -0.0002, 1.5, 0.31, -2.4, 1.42]",
                        "[0, 0, 0, 0, 0]"),
                   "a.yaml")
                   .distortion);
}

TEST(LensCalibration, ReportsThePlaceAndTheProblem) {
  const auto message = [](const std::string& text) {
    return io_error_of([&] { parse_lens_calibration(text, "a.yaml"); });
  };
  EXPECT_EQ(message("K: [1, 2"), "a.yaml:1:1: is not valid YAML: end of sequence flow not found");
  EXPECT_EQ(message("just words"),
            "a.yaml: found no keys; expected the YAML, XML or JSON of a lens's calibration: "
            "camera_matrix and "
            "distortion_coefficients, or K and D");
  EXPECT_EQ(message("D: [0, 0, 0, 0]\n"),
            "a.yaml: found no camera_matrix, or K; expected the nine numbers of a pinhole");
  EXPECT_EQ(message(with(ros_file, "[225, 0, ", "[225, 0.5, ")),
            "a.yaml:5:3: camera_matrix: expected [fx 0 cx; 0 fy cy; 0 0 1]: pixels without skew");
  EXPECT_EQ(message(with(ros_file, "[225, ", "[.nan, ")),
            "a.yaml:7:10: camera_matrix: found .nan; expected a finite number");
  EXPECT_EQ(
      message(with(ros_file, "equidistant", "mei")),
      "a.yaml:8:19: distortion_model: found mei; expected plumb_bob, rational_polynomial, radtan, "
      "equidistant, fisheye or none");
  EXPECT_EQ(message(with(ros_file, "[0.05, ", "[0.05, 0.1, ")),
            "a.yaml:10:3: distortion_coefficients = [0.05, 0.1, -0.01, 0.004, -0.001]; must be the "
            "4 numbers of a fisheye model: k1 k2 k3 k4");
  EXPECT_EQ(message(with(ros_message, "binning_x: 0", "binning_x: 2")),
            "a.yaml:11:12: binning_x: expected at most 1: images that are not binned");
  EXPECT_EQ(message(with(ros_message, "x_offset: 0", "x_offset: 8")),
            "a.yaml:13:17: roi.x_offset: expected 0: images that are not cropped");
}

/// One lens in the spelling of several programs and versions.
TEST(LensCalibration, ReadsTheSameLensFromEveryFormat) {
  const Lens expected{
      .fx_px = 60,
      .fy_px = 61,
      .cx_px = 39.5,
      .cy_px = 29.5,
      .distortion = LensDistortion{DistortionModel::opencv, {-0.1, 0.02, 1e-3, -2e-3}},
      .width_px = 80,
      .height_px = 60};
  const std::string xml = R"(<?xml version="1.0"?>
<!-- a lens -->
<opencv_storage>
<image_width>80</image_width> <image_height> 60
</image_height>
<camera_matrix type_id="opencv-matrix">
  <rows>3</rows><cols>3</cols><dt>d</dt>
  <data>
    60. 0. 3.95e+01 <!-- cx --> 0. 61.
    29.5 0. 0. 1.</data></camera_matrix>
<flags/>
<distortion_coefficients><data>-.1 2e-2 1e-3 -2e-3</data></distortion_coefficients>
</opencv_storage>
)";
  const std::string old_yaml =
      "%YAML:1.0\ncameraMatrix: !!opencv-matrix\n   rows: 3\n   data: [ 60., 0.,\n"
      "       39.5, 0., 61., 29.5, 0., 0., 1. ]  # fx, fy\nimageSize: [ 80, 60 ]\n"
      "distCoeffs:\n- -0.1\n- 0.02\n- 0.001\n- -0.002\n";
  std::string windows = "\xef\xbb\xbf";
  for (const char c : old_yaml) windows += c == '\n' ? "\r\n" : std::string(1, c);
  const std::string json =
      "{\n\t\"camera_matrix\": {\"type_id\": \"opencv-matrix\", \"rows\": 3, \"data\":\n\t"
      "[60.0, 0, 39.5, 0, 61, 29.5, 0, 0, 1]},\n\t\"distortion_coefficients\": [-0.1, 0.02, 0.001,"
      " -0.002],\n\t\"image_width\": 80, \"image_height\": 60}";
  const std::string rows =
      "K: [[60, 0, 39.5], [0, 61, 29.5], [0, 0, 1]]\nD: [[-0.1, 0.02, 0.001, -0.002]]\n"
      "width: 80\nheight: 60\ndistortion_model: plumb_bob\n";
  const std::string kalibr =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [-0.1, 0.02, 0.001, -0.002]\n"
      "  distortion_model: radtan\n  intrinsics: [60, 61, 39.5, 29.5]\n  resolution: [80, 60]\n";
  for (const std::string& text : {xml, old_yaml, windows, json, rows, kalibr})
    EXPECT_EQ(parse_lens_calibration(text, "a"), expected) << text;
}

TEST(LensCalibration, SelectsOneOfSeveralCamerasByName) {
  const std::string kalibr =
      "cam0: {camera_model: pinhole, distortion_coeffs: [0.1, 0, 0, 0], distortion_model: radtan, "
      "intrinsics: [60, 61, 39, 29]}\n"
      "cam1: {camera_model: pinhole, distortion_coeffs: [0.2, 0, 0, 0], distortion_model: "
      "equidistant, intrinsics: [70, 71, 38, 28]}\n"
      "cam2: {camera_model: omni, distortion_coeffs: [0, 0, 0, 0], distortion_model: radtan, "
      "intrinsics: [1, 70, 71, 38, 28]}\n";
  const std::string stereo =
      "cameraMatrix1: [60, 0, 39, 0, 61, 29, 0, 0, 1]\ndistCoeffs1: [0.1, 0, 0, 0, 0]\n"
      "cameraMatrix2: [70, 0, 38, 0, 71, 28, 0, 0, 1]\ndistCoeffs2: [0.2, 0, 0, 0, 0]\n"
      "R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n";
  const auto lens = [](const std::string& text, const std::string& camera) {
    return parse_lens_calibration(text, "a", {}, camera);
  };
  EXPECT_EQ(lens(kalibr, "cam0").fx_px, 60.0);
  EXPECT_EQ(lens(kalibr, "cam1").distortion,
            (LensDistortion{DistortionModel::fisheye, {0.2, 0, 0, 0}}));
  EXPECT_EQ(lens(stereo, "2").fx_px, 70.0);
  EXPECT_EQ(lens(stereo, "2").distortion->coefficients[0], 0.2);
  EXPECT_EQ(lens("M_left: [60, 0, 39, 0, 61, 29, 0, 0, 1]\nD_left: [0, 0, 0, 0]\n", "").fx_px,
            60.0);
  EXPECT_EQ(
      io_error_of([&] { lens(kalibr, ""); }),
      "a: found cameras cam0, cam1, cam2; expected calibration_camera = \"cam0\" or another of "
      "them");
  EXPECT_EQ(io_error_of([&] { lens(stereo, "3"); }), "a: found no camera 3; expected one of 1, 2");
  EXPECT_EQ(io_error_of([&] { lens(ros_message, "cam0"); }),
            "a: found no camera cam0; expected no calibration_camera, as the file has only one "
            "camera");
  EXPECT_EQ(io_error_of([&] { lens(kalibr, "cam2"); }),
            "a:3:22: camera_model: found omni; expected pinhole; calibrate the camera with that "
            "model");
}

const std::string azure_kinect = R"({"CalibrationInformation": {"Cameras": [
  {"Intrinsics": {"ModelParameterCount": 14, "ModelParameters":
      [0.51, 0.52, 0.48, 0.64, 0.5, -2.6, 1.5, 0.4, -2.4, 1.4, 0, 0, 0, 0],
    "ModelType": "CALIBRATION_LensDistortionModelBrownConrady"},
   "Location": "CALIBRATION_CameraLocationPV0", "MetricRadius": 0, "SensorHeight": 3072,
   "SensorWidth": 4096},
  {"Intrinsics": {"ModelParameterCount": 14, "ModelParameters":
      [0.5, 0.51, 0.49, 0.48, 0.92, 0.5, 0.03, 1.26, 0.75, 0.14, 0, 0, 2e-4, -3e-4],
    "ModelType": "CALIBRATION_LensDistortionModelBrownConrady"},
   "Location": "CALIBRATION_CameraLocationD0", "Purpose": "CALIBRATION_CameraPurposeDepth",
   "MetricRadius": 1.74, "Rt": {"Rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1], "Translation": [0, 0, 0]},
   "SensorHeight": 1024, "SensorWidth": 1024}]}})";

TEST(LensCalibration, ReadsTheDepthCameraOfAnAzureKinect) {
  const Lens expected{.fx_px = 0.49 * 1024,
                      .fy_px = 0.48 * 1024,
                      .cx_px = 0.5 * 1024 - 0.5,
                      .cy_px = 0.51 * 1024 - 0.5,
                      .distortion = LensDistortion{DistortionModel::opencv,
                                                   {0.92, 0.5, -3e-4, 2e-4, 0.03, 1.26, 0.75, 0.14},
                                                   1.74},
                      .frame_modes = FrameModes::azure_kinect};
  EXPECT_EQ(parse_lens_calibration(azure_kinect + '\0', "k.json"), expected);
  const Lens colour = parse_lens_calibration(azure_kinect, "k.json", {}, "PV0");
  EXPECT_EQ(colour.width_px, 4096);
  EXPECT_EQ(colour.distortion->max_radius, 1.7);  // default of the SDK, as the file has none
  const auto message = [](const std::string& old, const std::string& fresh) {
    return io_error_of(
        [&] { parse_lens_calibration(with(azure_kinect, old, fresh), "k", {}, "PV0"); });
  };
  EXPECT_EQ(
      message("1.4, 0, 0, 0, 0]", "1.4, 0.1, 0, 0, 0]"),
      "k:3:7: ModelParameters: found a centre of distortion of (0.1, 0); expected (0, 0), the "
      "optical axis");
  EXPECT_EQ(
      message("ModelBrownConrady", "ModelTheta"),
      "k:4:18: ModelType: found CALIBRATION_LensDistortionModelTheta; expected BrownConrady or "
      "Rational6KT");
  EXPECT_EQ(message("\"SensorWidth\": 4096", "\"Sensor\": 4096"),
            "k:2:3: found no SensorWidth; expected the calibration of an Azure Kinect");
}

/// Rays of all modes, compared with the SDK's projection onto the whole sensor.
TEST(LensCalibration, FramesOfAnAzureKinectAreRegionsOfTheSensor) {
  struct Mode {
    int width, height, binning, column, row;
  };
  for (const Mode& mode : {Mode{1024, 1024, 1, 0, 0}, Mode{640, 576, 1, 192, 180},
                           Mode{320, 288, 2, 192, 180}, Mode{512, 512, 2, 0, 0}})
    for (const bool is_6kt : {false, true}) {
      std::string text = azure_kinect;
      for (std::size_t at; is_6kt && (at = text.find("BrownConrady")) != std::string::npos;)
        text.replace(at, 12, "Rational6KT");
      const PinholeView view =
          view_of(parse_lens_calibration(text, "k.json"), mode.width, mode.height);
      EXPECT_NO_THROW(view.validate());
      for (int row = 0; row < mode.height; row += 41)
        for (int column = 0; column < mode.width; column += 37) {
          const Eigen::Vector3d ray = view.ray(row, column);
          const double x = ray.x() / ray.z(), y = ray.y() / ray.z(), q = x * x + y * y;
          if (std::isnan(x)) {  // beyond 60 degrees
            EXPECT_GT(std::hypot(column - 0.5 * mode.width, row - 0.5 * mode.height),
                      0.45 * 1024 / mode.binning);
            continue;
          }
          EXPECT_LE(std::sqrt(q), 1.74);
          const double radial =
              (1 + q * (0.92 + q * (0.5 + q * 0.03))) / (1 + q * (1.26 + q * (0.75 + q * 0.14)));
          const double cross = is_6kt ? 1.0 : 2.0, p1 = -3e-4, p2 = 2e-4;
          const double u = x * radial + (q + 2 * x * x) * p2 + cross * x * y * p1,
                       v = y * radial + (q + 2 * y * y) * p1 + cross * x * y * p2;
          // In sensor pixels from its corner.
          EXPECT_NEAR(1024 * (0.49 * u + 0.5), mode.column + mode.binning * (column + 0.5), 1e-6);
          EXPECT_NEAR(1024 * (0.48 * v + 0.51), mode.row + mode.binning * (row + 0.5), 1e-6);
        }
    }
}

TEST(LensCalibration, JsonPreservesTheLens) {
  for (const Lens& lens : {parse_lens_calibration(azure_kinect, "k.json"),
                           parse_lens_calibration(opencv_yaml, "a"), Lens{.rays = "/a/rays.npy"}})
    EXPECT_EQ(lens_from_json(lens_to_json(lens)), lens);
  EXPECT_EQ(io_error_of([] { lens_from_json(R"({"fx_px": 1, "fy_px": 1, "cx_px": 1})"); }),
            "lens: found no cy_px; expected a line such as `cy_px = 239.5`");
}

TEST(LensCalibration, ReportsTheLineInXml) {
  const auto message = [](const std::string& text) {
    return io_error_of([&] { parse_lens_calibration(text, "a.xml"); });
  };
  EXPECT_EQ(message("<a>\n<b>1</c></a>"), "a.xml:2: is not valid XML: found </c>; expected </b>");
  EXPECT_EQ(message("<a>\n<b>1"),
            "a.xml:2: is not valid XML: found the end of the file; expected </b>");
  EXPECT_EQ(message("<a>\n<b"), "a.xml:2: is not valid XML: found <; expected > after it");
  EXPECT_EQ(message("<a>\n<K>\n<data>1 2\n3</data></K><D>0 0 0 0</D></a>"),
            "a.xml:2: camera_matrix: found 3 numbers; expected 9, or fx fy cx cy");
}

TEST(LensCalibration, ACameraReadsItsLensFromAFileNextToItAndIsWrittenWithTheNumbers) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "lens.yml") << opencv_yaml;
  const std::filesystem::path path = directory.path() / "camera.toml";
  std::ofstream(path) << "fundamental_frequency_hz = 20e6\n[lens]\ncalibration = \"lens.yml\"\n";
  const Camera camera = read_camera_toml(path);
  EXPECT_EQ(camera.lens, parse_lens_calibration(opencv_yaml, "a.yml"));
  EXPECT_EQ(parse_camera_toml(camera_to_toml(camera), camera.name), camera);
  const std::vector<std::string> settings{"lens.fx_px=500"};
  EXPECT_EQ(with_settings(camera, settings).lens->fx_px, 500.0);
  std::ofstream(path, std::ios::app) << "fx_px = 500\n";
  EXPECT_EQ(io_error_of([&] { read_camera_toml(path); }),
            path.string() + ":4:9: lens.fx_px: is only valid with no calibration");
}

}  // namespace
}  // namespace tofsmith
