// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

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

// The consumer project builds and runs this program, so the README's example works as it stands.
TEST(Readme, ShowsTheProgramThatTheConsumerProjectRuns) {
  std::string program = read("tests/consumer/main.cpp");
  ASSERT_FALSE(program.empty());
  for (int licence_line = 0; licence_line < 2; ++licence_line)
    program.erase(0, program.find('\n') + 1);
  EXPECT_NE(read("README.md").find("```cpp\n" + program + "```"), std::string::npos);
}

/// The first TOML example below a heading.
std::string toml_below(const std::string& heading) {
  const std::string readme = read("README.md");
  const std::size_t section = readme.find("\n## " + heading + "\n");
  if (section == std::string::npos) return "no such heading";
  const std::size_t begin = readme.find("```toml\n", section) + 8;
  return readme.substr(begin, readme.find("```", begin) - begin);
}

TEST(Readme, ShowsACameraThatCanBeRead) {
  const std::string toml = toml_below("Your camera");
  EXPECT_DOUBLE_EQ(tofsmith::parse_camera_toml(toml, "README.md").light.peak_factor, 15.0);
}

TEST(Readme, ShowsASceneThatCanBeRead) {
  const std::string toml = toml_below("Your scene");
  EXPECT_EQ(tofsmith::parse_scene_toml(toml, "README.md").shapes.size(), 4u);
}

}  // namespace
