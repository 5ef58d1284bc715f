// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "damaged_files.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

constexpr std::string_view shortest = "fundamental_frequency_hz = 20e6\n";

TEST(CameraLens, BlurAndPinholeAreIndependent) {
  const std::string head(shortest);
  const Camera blurs = parse_camera_toml(
      head + "[lens]\nblur = \"gaussian\"\nblur_sigma_px = 0.5\npixel_samples = 3\n");
  EXPECT_FALSE(blurs.lens.has_value());
  EXPECT_EQ(blurs.blur,
            (LensBlur{.kind = LensBlur::Kind::gaussian, .blur_sigma_px = 0.5, .pixel_samples = 3}));
  EXPECT_EQ(parse_camera_toml(camera_to_toml(blurs), blurs.name), blurs);
  const Camera sharp =
      parse_camera_toml(head + "[lens]\nfx_px = 1\nfy_px = 1\ncx_px = 1\ncy_px = 1\n");
  EXPECT_TRUE(sharp.lens.has_value());
  EXPECT_FALSE(sharp.blur.has_value());
}

TEST(CameraLens, DistortionIsReadBack) {
  std::string text(shortest);
  text +=
      "[lens]\nfx_px = 60\nfy_px = 60\ncx_px = 39.5\ncy_px = 29.5\ndistortion_model = "
      "\"fisheye\"\ndistortion = [0.05, -0.01, 0.004, 0]\nwidth_px = 80\nheight_px = 60\n";
  const Camera camera = parse_camera_toml(text);
  EXPECT_EQ(camera.lens->distortion,
            (LensDistortion{DistortionModel::fisheye, {0.05, -0.01, 0.004, 0.0}}));
  EXPECT_EQ(camera.lens->width_px, 80);
  EXPECT_EQ(parse_camera_toml(camera_to_toml(camera), camera.name), camera);
}

TEST(CameraLens, AFileOfRaysReplacesThePinhole) {
  const Camera camera = parse_camera_toml(
      std::string(shortest) + "[lens]\nrays = \"maker/rays.npy\"\nblur = \"none\"\n",
      "/cameras/mine.toml");
  EXPECT_EQ(camera.lens, (Lens{.rays = "/cameras/maker/rays.npy"}));
  EXPECT_EQ(parse_camera_toml(camera_to_toml(camera), camera.name), camera);
  Camera both = camera;
  both.lens->fx_px = 60.0;
  EXPECT_THROW(both.validate(), std::invalid_argument);
}

struct BadLine {
  const char* line;
  const char* message;
};

TEST(CameraLens, ErrorsReportThePlaceAndTheRule) {
  for (const BadLine& bad :
       {BadLine{"lens.blur = \"gaussian\"",
                "c.toml:2:1: found no lens.blur_sigma_px; expected a line such as "
                "`blur_sigma_px = 0.5`"},
        BadLine{"lens.blur_sigma_px = 0.5",
                "c.toml:2:22: lens.blur_sigma_px: is only valid with blur = \"gaussian\""},
        BadLine{"lens = { blur = \"gaussian\", blur_sigma_px = 0 }",
                "c.toml:2:45: lens.blur_sigma_px = 0; must be in (0, 32]"},
        BadLine{"lens = { blur = \"disc\", focal_length_m = 1, f_number = 2, focus_distance_m = 1, "
                "pixel_pitch_m = 1 }",
                "c.toml:2:78: lens.focus_distance_m = 1; must be > lens.focal_length_m"},
        BadLine{
            "lens = { fx_px = 1, fy_px = 1, cx_px = 1, cy_px = 1, distortion = [1, 2] }",
            "c.toml:2:67: lens.distortion = [1, 2]; must be 4, 5, 8, 12 or 14 numbers: k1 k2 p1 "
            "p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [0 0]]]]"},
        BadLine{"lens = { fx_px = 1, fy_px = 1, cx_px = 1, cy_px = 1, distortion_model = \"mei\" }",
                "c.toml:2:73: lens.distortion_model: found \"mei\"; expected one of \"opencv\", "
                "\"fisheye\", \"rational-6kt\""},
        BadLine{"lens.calibration_camera = \"cam1\"",
                "c.toml:2:27: lens.calibration_camera: is only valid with calibration"},
        BadLine{"lens.distortion = [0, 0, 0, 0]",
                "c.toml:2:1: found no lens.fx_px; expected a line such as `fx_px = 525.0`"},
        BadLine{"lens = { fx_px = 1, fy_px = 1, cx_px = 1, cy_px = 1, width_px = 4 }",
                "c.toml:2:65: lens.width_px = 4; requires lens.height_px: set both or neither"},
        BadLine{"lens = { rays = \"r.npy\", calibration = \"lens.yml\" }",
                "c.toml:2:40: lens.calibration: is only valid with no rays"},
        BadLine{"lens.pixel_samples = 17",
                "c.toml:2:22: lens.pixel_samples = 17; must be in [1, 16]"}})
    EXPECT_EQ(
        io_error_of([&] { parse_camera_toml(std::string(shortest) + bad.line + "\n", "c.toml"); }),
        bad.message);
}

}  // namespace
}  // namespace tofsmith
