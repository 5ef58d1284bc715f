// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/documents/lens_calibration.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

/// As cv::FileStorage and OpenCV's calibration sample write it.
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

/// As a camera_info message is printed.
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

/// As ROS's camera_calibration writes a camera's file.
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

TEST(LensCalibration, ReadsWhatOpenCvWrites) {
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

TEST(LensCalibration, ReadsWhatRosWrites) {
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

TEST(LensCalibration, FourNumbersAreAFisheyesIfTheFileOrTheCameraSaysSo) {
  const std::string plain = with(ros_file, "distortion_model: equidistant\n", "");
  using enum DistortionModel;
  EXPECT_EQ(parse_lens_calibration(plain, "a").distortion->model, opencv);
  EXPECT_EQ(parse_lens_calibration(plain, "a", fisheye).distortion->model, fisheye);
  EXPECT_EQ(parse_lens_calibration(plain + "fisheye_model: 1\n", "a").distortion->model, fisheye);
}

TEST(LensCalibration, DistortionOfZeroIsNone) {
  EXPECT_FALSE(parse_lens_calibration(
                   with(ros_message, "[0.42, -2.6, 0.0006, -0.0002, 1.5, 0.31, -2.4, 1.42]",
                        "[0, 0, 0, 0, 0]"),
                   "a.yaml")
                   .distortion);
}

TEST(LensCalibration, NamesThePlaceAndWhatIsWrong) {
  const auto message = [](const std::string& text) {
    return io_error_of([&] { parse_lens_calibration(text, "a.yaml"); });
  };
  EXPECT_EQ(message("K: [1, 2"), "a.yaml:1:1: is no YAML: end of sequence flow not found");
  EXPECT_EQ(message("just words"),
            "a.yaml: found no keys; expected the YAML of a lens's calibration: camera_matrix and "
            "distortion_coefficients, or K and D");
  EXPECT_EQ(message("D: [0, 0, 0, 0]\n"),
            "a.yaml: found no camera_matrix, or K; expected the nine numbers of a pinhole");
  EXPECT_EQ(message(with(ros_file, "[225, 0, ", "[225, 0.5, ")),
            "a.yaml:5:3: camera_matrix: expected [fx 0 cx; 0 fy cy; 0 0 1]: pixels without skew");
  EXPECT_EQ(message(with(ros_file, "[225, ", "[.nan, ")),
            "a.yaml:7:10: camera_matrix: found .nan; expected a finite number");
  EXPECT_EQ(message(with(ros_file, "equidistant", "mei")),
            "a.yaml:8:19: distortion_model: found mei; expected plumb_bob, rational_polynomial, "
            "equidistant or fisheye");
  EXPECT_EQ(message(with(ros_file, "[0.05, ", "[0.05, 0.1, ")),
            "a.yaml:10:3: distortion_coefficients = [0.05, 0.1, -0.01, 0.004, -0.001]; must be 4 "
            "numbers of a fisheye: k1 k2 k3 k4");
  EXPECT_EQ(message(with(ros_message, "binning_x: 0", "binning_x: 2")),
            "a.yaml:11:12: binning_x: expected at most 1: images that are not binned");
  EXPECT_EQ(message(with(ros_message, "x_offset: 0", "x_offset: 8")),
            "a.yaml:13:17: roi.x_offset: expected 0: images that are not cut");
}

TEST(LensCalibration, ACameraTakesItsLensFromTheFileBesideItAndIsWrittenWithTheNumbers) {
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
