// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "damaged_files.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

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
  EXPECT_EQ(refusal("light.generator.amplitude_bit = 8"),
            "c.toml:2:17: unknown key light.generator.amplitude_bit; did you mean "
            "light.generator.amplitude_bits, in bits?");
}

}  // namespace
}  // namespace tofsmith
