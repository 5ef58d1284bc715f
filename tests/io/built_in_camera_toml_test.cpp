// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

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

}  // namespace
}  // namespace tofsmith
