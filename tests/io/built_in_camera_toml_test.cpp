// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tofsmith/code/families.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/camera_toml.hpp"

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

TEST(BuiltInCameras, PlayTheFamilyThatTheyName) {
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

TEST(BuiltInCameras, ReadBackFromTheirTomlAsTheSame) {
  for (const std::string& name : built_in_camera_names())
    EXPECT_EQ(parse_camera_toml(built_in_camera_toml(name), "mine.toml"), built_in_camera(name))
        << name;
}

TEST(BuiltInCameras, SayOfEveryValueWhereItIsFrom) {
  for (const BuiltInCamera& listed : list_built_in_cameras()) {
    std::istringstream lines(built_in_camera_toml(listed.name));
    for (std::string line; std::getline(lines, line);) {
      if (line.find(" = ") == std::string::npos || line.starts_with("name")) continue;
      EXPECT_THAT(line, HasSubstr("  # ")) << listed.name;
    }
  }
}

TEST(BuiltInCameras, HaveSourcesOfKeysOnly) {
  const std::vector<std::string> keys = camera_keys();
  for (const BuiltInCamera& listed : list_built_in_cameras())
    for (const NumberSource& known : listed.sources)
      EXPECT_TRUE(std::ranges::any_of(
          keys, [&](const std::string& key) { return key.starts_with(known.key); }))
          << listed.name << " " << known.key;
}

TEST(BuiltInCameras, TakeTheSourceOfTheTableForItsKeys) {
  const BuiltInCamera listed{"x", "", "", {{"sensor", "a"}, {"sensor.taps", "b"}}};
  EXPECT_EQ(listed.source_of("sensor.taps"), "b");
  EXPECT_EQ(listed.source_of("sensor.drain"), "a");
  EXPECT_EQ(listed.source_of("sensors"), "assumed");
}

TEST(BuiltInCameras, TakeTheGreatestCommonDivisorForTheFundamental) {
  EXPECT_NEAR(built_in_camera("kinect-v2").range_m(), speed_of_light_m_per_s / 16e6, 1e-9);
}

}  // namespace
}  // namespace tofsmith
