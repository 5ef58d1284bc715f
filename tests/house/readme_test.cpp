// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/scene_toml.hpp"

namespace {

std::string read(const std::string& path) {
  std::ifstream file(std::string(TOFSMITH_SOURCE_DIR "/") + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The consumer project builds and runs this program, so that the README's example works.
TEST(Readme, ContainsTheProgramOfTheConsumerProject) {
  std::string program = read("tests/consumer/main.cpp");
  ASSERT_FALSE(program.empty());
  for (int licence_line = 0; licence_line < 2; ++licence_line)
    program.erase(0, program.find('\n') + 1);
  EXPECT_NE(read("README.md").find("```cpp\n" + program + "```"), std::string::npos);
}

// Further details belong in docs/.
TEST(Readme, HasLimitedLength) {
  const std::string readme = read("README.md");
  EXPECT_LE(std::count(readme.begin(), readme.end(), '\n'), 150);
}

/// Returns the first TOML example of a page, or after a heading.
std::string toml_of(const std::string& path, const std::string& heading = "") {
  const std::string page = read(path);
  const std::size_t fence = page.find("```toml\n", page.find(heading));
  if (fence == std::string::npos) return "no TOML example";
  const std::size_t begin = page.find('\n', fence) + 1;
  return page.substr(begin, page.find("```", begin) - begin);
}

TEST(Pages, ContainAValidCamera) {
  const std::string path = "docs/cameras.md";
  EXPECT_DOUBLE_EQ(tofsmith::parse_camera_toml(toml_of(path), path).light.peak_factor, 15.0);
}

TEST(Pages, ContainAValidScene) {
  const std::string path = "docs/scenes.md";
  EXPECT_EQ(tofsmith::parse_scene_toml(toml_of(path), path).shapes.size(), 4u);
}

TEST(Pages, ContainAMovingSceneAsDescribed) {
  const std::string path = "docs/scenes.md";
  const auto scene = tofsmith::parse_scene_toml(toml_of(path, "## In motion"), path);
  ASSERT_EQ(scene.shape_motions.size(), 3u);
  const auto later = scene.at(0.1);
  const auto ball_m = std::get<tofsmith::Sphere>(later.shapes.back()).centre;
  EXPECT_TRUE(ball_m.isApprox(Eigen::Vector3d(0.1, 0.0, 1.5))) << ball_m.transpose();
  EXPECT_TRUE(later.camera_to_world.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 0.02)));
}

}  // namespace
