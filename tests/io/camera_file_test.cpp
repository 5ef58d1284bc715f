// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/code/families.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/raw_frames.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;

TEST(BuiltInCameras, AreValidUnderTheirNames) {
  for (const BuiltInCamera& listed : list_built_in_cameras()) {
    const Camera camera = built_in_camera(listed.name);
    EXPECT_NO_THROW(camera.validate()) << listed.name;
    EXPECT_EQ(camera.name, listed.name);
    EXPECT_FALSE(listed.description.empty()) << listed.name;
  }
}

TEST(BuiltInCameras, FitTheFamilyThatTheyName) {
  for (const BuiltInCamera& listed : list_built_in_cameras()) {
    const Camera camera = built_in_camera(listed.name);
    if (listed.code.empty()) {
      EXPECT_GT(camera.sensor.taps, 2) << listed.name;
      continue;
    }
    ASSERT_EQ(why_no_family(listed.code, camera), std::nullopt) << listed.name;
    EXPECT_EQ(why_not_playable(build_family(listed.code, camera), camera), std::nullopt)
        << listed.name;
  }
}

TEST(BuiltInCameras, AreReadBackFromTheirToml) {
  for (const std::string& name : built_in_camera_names())
    EXPECT_EQ(parse_camera_toml(built_in_camera_toml(name), "mine.toml"), built_in_camera(name))
        << name;
}

TEST(BuiltInCameras, GiveTheSourceOfEveryValue) {
  for (const BuiltInCamera& listed : list_built_in_cameras()) {
    std::istringstream lines(built_in_camera_toml(listed.name));
    for (std::string line; std::getline(lines, line);) {
      if (line.find(" = ") == std::string::npos || line.starts_with("name")) continue;
      EXPECT_THAT(line, HasSubstr("  # ")) << listed.name;
    }
  }
}

TEST(BuiltInCameras, HaveSourcesOfExistingKeysOnly) {
  const std::vector<std::string> keys = camera_keys();
  for (const BuiltInCamera& listed : list_built_in_cameras())
    for (const NumberSource& known : listed.sources)
      EXPECT_TRUE(std::ranges::any_of(
          keys, [&](const std::string& key) { return key.starts_with(known.key); }))
          << listed.name << " " << known.key;
}

TEST(BuiltInCameras, SourcesOfTablesApplyToTheirKeys) {
  const BuiltInCamera listed{"x", "", "", {{"sensor", "a"}, {"sensor.taps", "b"}}};
  EXPECT_EQ(listed.source_of("sensor.taps"), "b");
  EXPECT_EQ(listed.source_of("sensor.drain"), "a");
  EXPECT_EQ(listed.source_of("sensors"), "assumed");
}

/// Writes four images of 11 signed bits, bottom row first. Third - first and fourth - second are
/// the sine and cosine of a phase that increases with the row.
void write_arducam_dump(const std::filesystem::path& path, int width, int height) {
  std::ofstream file(path, std::ios::binary);
  for (int image = 0; image < 4; ++image)
    for (int i = 0; i < width * height; ++i) {
      const int row = height - 1 - i / width;
      const double phase = 2.0 * std::numbers::pi * (row + 0.5) / height;
      const double wave = image % 2 == 0 ? std::sin(phase) : std::cos(phase);
      const auto number = static_cast<int>(std::lround((image < 2 ? -500.0 : 500.0) * wave));
      const auto bits = static_cast<unsigned>(number) & 0x7ffu;
      file.put(static_cast<char>(bits & 0xffu)).put(static_cast<char>(bits >> 8));
    }
}

TEST(BuiltInCameras, RawFramesGiveTheDepthOfTheDriver) {
  const TemporaryDirectory directory;
  const Camera camera = built_in_camera("arducam-tof");
  const RawFormat format = parse_raw_format(built_in_raw_format_toml("arducam-tof"));
  write_arducam_dump(directory / "dump.bin", format.width, format.height);
  RawReadOptions reading;
  reading.format = format;
  const RawFrames raw = read_raw_frames(std::vector{directory / "dump.bin"}, reading);
  const Decoder decoder(load_decoding_table("sinusoid-k4", camera).table);
  DepthImage depth = decoder.decode(raw);
  for (int row = 0; row < format.height; ++row)
    EXPECT_NEAR(depth.depth_m.pixels[static_cast<std::size_t>(row * format.width)],
                camera.range_m() * (row + 0.5) / format.height, 2e-3);
}

TEST(BuiltInCameras, HaveNoInventedRawFrames) {
  for (const std::string& name : built_in_raw_format_names())
    EXPECT_NO_THROW(built_in_camera(name)) << name;
  for (const char* name : {"kinect-v1", "kinect-v2", "epc660"})
    EXPECT_THROW(built_in_raw_format_toml(name), std::invalid_argument) << name;
}

TEST(BuiltInCameras, TheFundamentalIsTheGreatestCommonDivisor) {
  EXPECT_NEAR(built_in_camera("kinect-v2").range_m(), speed_of_light_m_per_s / 16e6, 1e-9);
}

std::string with_line(const std::string& line) {
  return "fundamental_frequency_hz = 20e6\n" + line + "\n";
}
std::string refusal(const std::string& line) {
  return io_error_of([&] { parse_camera_toml(with_line(line), "c.toml"); });
}

TEST(CameraToml, AnEmptyGeneratorHasTheLimitsOfThePrototype) {
  const Camera camera = parse_camera_toml(with_line("light.generator = {}"), "c.toml");
  ASSERT_TRUE(camera.light.generator.has_value());
  EXPECT_EQ(camera.light.generator->sample_rate_hz, 500e6);
  EXPECT_EQ(camera.light.generator->amplitude_bits, 14);
  EXPECT_FALSE(camera.sensor.generator.has_value());
}

TEST(CameraToml, RejectsInvalidGenerators) {
  EXPECT_EQ(refusal("light.generator = { sample_rate_hz = 39e6 }"),
            "c.toml:2:38: light.generator.sample_rate_hz = 3.9e+07; must give 2 to 1048576 points "
            "per period at fundamental_frequency_hz = 20000000");
  EXPECT_EQ(refusal("sensor.generator = { sample_rate_hz = -1 }"),
            "c.toml:2:39: sensor.generator.sample_rate_hz = -1; must be finite and > 0");
  EXPECT_EQ(refusal("sensor.generator.amplitude_bits = 0"),
            "c.toml:2:35: sensor.generator.amplitude_bits = 0; must be in [1, 24]");
}

TEST(CameraLens, BlurAndPinholeAreIndependent) {
  const Camera blurs = parse_camera_toml(
      with_line("[lens]\nblur = \"gaussian\"\nblur_sigma_px = 0.5\npixel_samples = 3"));
  EXPECT_FALSE(blurs.lens.has_value());
  EXPECT_EQ(blurs.blur,
            (LensBlur{.kind = LensBlur::Kind::gaussian, .blur_sigma_px = 0.5, .pixel_samples = 3}));
  EXPECT_EQ(parse_camera_toml(camera_to_toml(blurs), blurs.name), blurs);
  const Camera sharp =
      parse_camera_toml(with_line("[lens]\nfx_px = 1\nfy_px = 1\ncx_px = 1\ncy_px = 1"));
  EXPECT_TRUE(sharp.lens.has_value());
  EXPECT_FALSE(sharp.blur.has_value());
}

TEST(CameraLens, DistortionIsReadBack) {
  const Camera camera = parse_camera_toml(with_line(
      "[lens]\nfx_px = 60\nfy_px = 60\ncx_px = 39.5\ncy_px = 29.5\ndistortion_model = "
      "\"fisheye\"\ndistortion = [0.05, -0.01, 0.004, 0]\nwidth_px = 80\nheight_px = 60"));
  EXPECT_EQ(camera.lens->distortion,
            (LensDistortion{DistortionModel::fisheye, {0.05, -0.01, 0.004, 0.0}}));
  EXPECT_EQ(camera.lens->width_px, 80);
  EXPECT_EQ(parse_camera_toml(camera_to_toml(camera), camera.name), camera);
}

TEST(CameraLens, AFileOfRaysReplacesThePinhole) {
  const Camera camera = parse_camera_toml(
      with_line("[lens]\nrays = \"maker/rays.npy\"\nblur = \"none\""), "/cameras/mine.toml");
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
                "2:1: found no lens.blur_sigma_px; expected a line such as `blur_sigma_px = 0.5`"},
        BadLine{"lens.blur_sigma_px = 0.5",
                "2:22: lens.blur_sigma_px: is only valid with blur = \"gaussian\""},
        BadLine{"lens = { blur = \"gaussian\", blur_sigma_px = 0 }",
                "2:45: lens.blur_sigma_px = 0; must be in (0, 32]"},
        BadLine{"lens = { blur = \"disc\", focal_length_m = 1, f_number = 2, focus_distance_m = 1, "
                "pixel_pitch_m = 1 }",
                "2:78: lens.focus_distance_m = 1; must be > lens.focal_length_m"},
        BadLine{"lens = { fx_px = 1, fy_px = 1, cx_px = 1, cy_px = 1, distortion = [1, 2] }",
                "2:67: lens.distortion = [1, 2]; must be 4, 5, 8, 12 or 14 numbers: k1 k2 p1 p2 "
                "[k3 [k4 k5 k6 [s1 s2 s3 s4 [0 0]]]]"},
        BadLine{"lens = { fx_px = 1, fy_px = 1, cx_px = 1, cy_px = 1, distortion_model = \"mei\" }",
                "2:73: lens.distortion_model: found \"mei\"; expected one of \"opencv\", "
                "\"fisheye\", \"rational-6kt\""},
        BadLine{"lens.calibration_camera = \"cam1\"",
                "2:27: lens.calibration_camera: is only valid with calibration"},
        BadLine{"lens.distortion = [0, 0, 0, 0]",
                "2:1: found no lens.fx_px; expected a line such as `fx_px = 525.0`"},
        BadLine{"lens = { fx_px = 1, fy_px = 1, cx_px = 1, cy_px = 1, width_px = 4 }",
                "2:65: lens.width_px = 4; requires lens.height_px: set both or neither"},
        BadLine{"lens = { rays = \"r.npy\", calibration = \"lens.yml\" }",
                "2:40: lens.calibration: is only valid with no rays"},
        BadLine{"lens.pixel_samples = 17", "2:22: lens.pixel_samples = 17; must be in [1, 16]"}})
    EXPECT_EQ(refusal(bad.line), std::string("c.toml:") + bad.message);
}

}  // namespace

}  // namespace tofsmith
