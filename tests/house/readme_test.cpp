// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "tofsmith/io/camera_toml.hpp"

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

TEST(Readme, ShowsACameraThatCanBeRead) {
  const std::string readme = read("README.md");
  const std::size_t begin = readme.find("```toml\n") + 8;
  const std::string toml = readme.substr(begin, readme.find("```", begin) - begin);
  EXPECT_DOUBLE_EQ(tofsmith::parse_camera_toml(toml, "README.md").light.peak_factor, 15.0);
}

}  // namespace
