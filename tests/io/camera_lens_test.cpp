// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "damaged_files.hpp"
#include "tofsmith/io/camera_toml.hpp"

namespace tofsmith {
namespace {

constexpr std::string_view shortest = "fundamental_frequency_hz = 20e6\n";

TEST(CameraLens, ALensMayBlurWithoutAPinholeAndTheOtherWayRound) {
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

struct BadLine {
  const char* line;
  const char* message;
};

TEST(CameraLens, IsRefusedWithThePlaceAndTheRule) {
  for (const BadLine& bad :
       {BadLine{"lens.blur = \"gaussian\"",
                "c.toml:2:1: found no lens.blur_sigma_px; expected a line such as "
                "`blur_sigma_px = 0.5`"},
        BadLine{"lens.blur_sigma_px = 0.5",
                "c.toml:2:22: lens.blur_sigma_px: has a meaning only with blur = \"gaussian\""},
        BadLine{"lens = { blur = \"gaussian\", blur_sigma_px = 0 }",
                "c.toml:2:45: lens.blur_sigma_px = 0; must be in (0, 32]"},
        BadLine{"lens = { blur = \"disc\", focal_length_m = 1, f_number = 2, focus_distance_m = 1, "
                "pixel_pitch_m = 1 }",
                "c.toml:2:78: lens.focus_distance_m = 1; must be finite and > "
                "lens.focal_length_m: nothing nearer is ever sharp"},
        BadLine{"lens.pixel_samples = 17",
                "c.toml:2:22: lens.pixel_samples = 17; must be in [1, 16]"}})
    EXPECT_EQ(
        io_error_of([&] { parse_camera_toml(std::string(shortest) + bad.line + "\n", "c.toml"); }),
        bad.message);
}

}  // namespace
}  // namespace tofsmith
