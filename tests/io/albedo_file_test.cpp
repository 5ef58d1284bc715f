// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "damaged_files.hpp"
#include "io/images/exr.hpp"
#include "io/images/pfm.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

constexpr auto overwrite = OutputPolicy::overwrite;

std::string refusal(const std::filesystem::path& path) {
  return io_error_of([&] { read_albedo(path); });
}

TEST(AlbedoFile, PngValuesAreLinearizedByDefault) {
  const TemporaryDirectory directory;
  for (const int bits : {8, 16}) {
    const std::uint16_t half = bits == 8 ? 128 : 32896;  // 128 x 257
    const auto white = static_cast<std::uint16_t>(bits == 8 ? 255 : 65535);
    write_png(directory / "a.png", PngImage{1, 3, 1, bits, {0, half, white}}, overwrite);
    const Image<float> srgb = read_albedo(directory / "a.png");
    EXPECT_EQ(srgb(0, 0), 0.0f);
    EXPECT_NEAR(srgb(0, 1), linear_from_srgb(128 / 255.0), 1e-7);
    EXPECT_NEAR(srgb(0, 2), 1.0f, 1e-7);
    const Image<float> linear = read_albedo(directory / "a.png", Transfer::linear);
    EXPECT_NEAR(linear(0, 1), 128 / 255.0, 1e-7);
  }
}

TEST(AlbedoFile, ColoursBecomeLuminanceInEveryFormat) {
  const TemporaryDirectory directory;
  const std::vector<float> rgb = {0.25f, 0.5f, 1.0f, 1.0f, 0.0f, 0.0f};
  write_npy(directory / "a.npy", NpyArray::of<float>({1, 2, 3}, rgb), overwrite);
  write_pfm(directory / "a.pfm", PfmImage{1, 2, 3, 1.0, rgb}, overwrite);
  ExrPlanes planes;
  for (std::size_t c = 0; c < 3; ++c) {
    Image<float> plane(1, 2);
    plane.pixels = {rgb[c], rgb[3 + c]};
    planes[std::string(1, "RGB"[c])] = plane;
  }
  write_exr(directory / "a.exr", planes, overwrite);
  for (const char* name : {"a.npy", "a.pfm", "a.exr"}) {
    const Image<float> albedo = read_albedo(directory / name);
    EXPECT_FLOAT_EQ(albedo(0, 0), 0.2126f * 0.25f + 0.7152f * 0.5f + 0.0722f) << name;
    EXPECT_FLOAT_EQ(albedo(0, 1), 0.2126f) << name;
  }
}

TEST(AlbedoFile, LinearizesBeforeConvertingColourAndIgnoresAlpha) {
  const TemporaryDirectory directory;
  write_png(directory / "a.png", PngImage{1, 1, 4, 8, {255, 128, 0, 7}}, overwrite);
  EXPECT_NEAR(read_albedo(directory / "a.png")(0, 0),
              luminance_rec709(1.0, linear_from_srgb(128 / 255.0), 0.0), 1e-6);
  write_png(directory / "a.png", PngImage{1, 1, 2, 8, {255, 7}}, overwrite);
  EXPECT_NEAR(read_albedo(directory / "a.png")(0, 0), 1.0, 1e-6);
}

TEST(AlbedoFile, GreyValuesAreUnchanged) {
  const TemporaryDirectory directory;
  const std::vector<double> grey = {0.25, 0.75};
  write_npy(directory / "a.npy", NpyArray::of<double>({2, 1}, grey), overwrite);
  write_pfm(directory / "a.pfm", PfmImage{2, 1, 1, 1.0, {0.25f, 0.75f}}, overwrite);
  Image<float> plane(2, 1);
  plane.pixels = {0.25f, 0.75f};
  write_exr(directory / "a.exr", {{"Y", plane}, {"A", Image<float>(2, 1)}}, overwrite);
  write_exr(directory / "b.exr", {{"albedo", plane}}, overwrite);
  for (const char* name : {"a.npy", "a.pfm", "a.exr", "b.exr"})
    EXPECT_EQ(read_albedo(directory / name).pixels, plane.pixels) << name;
}

TEST(AlbedoFile, RejectsInvalidImages) {
  const TemporaryDirectory directory;
  EXPECT_THAT(refusal(directory / "a.jpg"), HasSubstr("expected one of .png, .npy, .exr, .pfm"));
  EXPECT_THAT(refusal(directory / "a.png"), HasSubstr("no such file"));
  write_npy(directory / "a.npy", NpyArray(NpyType::float32, {2, 2, 4}), overwrite);
  EXPECT_THAT(refusal(directory / "a.npy"), HasSubstr("shape (2, 2, 4); expected (H, W) or"));
  write_npy(directory / "a.npy", NpyArray(NpyType::uint8, {2, 2, 3}), overwrite);
  EXPECT_THAT(refusal(directory / "a.npy"), HasSubstr("type uint8"));
  write_npy(directory / "a.npy", NpyArray(NpyType::float32, {0, 2, 3}), overwrite);
  EXPECT_THAT(refusal(directory / "a.npy"), HasSubstr("0 x 2 pixels"));
  write_exr(directory / "a.exr", {{"R", Image<float>(1, 1)}, {"G", Image<float>(1, 1)}}, overwrite);
  EXPECT_THAT(refusal(directory / "a.exr"), HasSubstr("found the channels G, R"));
}

TEST(AlbedoOfPicture, IsScaledDownIfBrighterThanOne) {
  Image<float> picture(1, 2, 2.0f);
  picture(0, 1) = 4.0f;
  EXPECT_EQ(albedo_of_picture(picture, "a.npy").pixels, (std::vector<float>{0.5f, 1.0f}));
  picture(0, 1) = 0.25f;
  picture(0, 0) = 1.0f;
  EXPECT_EQ(albedo_of_picture(picture, "a.npy").pixels, picture.pixels);
}

TEST(AlbedoOfPicture, MayBeUnknownWithoutReturn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Image<float> picture(1, 2, 0.5f), depth_m(1, 2, 1.0f);
  picture(0, 1) = nan;
  EXPECT_EQ(io_error_of([&] { albedo_of_picture(picture, "a.npy", depth_m); }),
            "a.npy: row 0, column 1: found nan; expected a finite number >= 0");
  depth_m(0, 1) = nan;
  EXPECT_EQ(albedo_of_picture(picture, "a.npy", depth_m).pixels, (std::vector<float>{0.5f, 0.0f}));
  picture(0, 0) = -0.5f;
  EXPECT_EQ(io_error_of([&] { albedo_of_picture(picture, "a.npy", depth_m); }),
            "a.npy: row 0, column 0: found -0.5; expected a finite number >= 0");
}

TEST(AmbientScale, IsFiniteAndNeverNegative) {
  const TemporaryDirectory directory;
  Image<float> picture(1, 2, 3.0f);
  write_float_image(directory / "a.npy", picture, "a", OutputPolicy::overwrite);
  EXPECT_EQ(read_ambient_scale(directory / "a.npy").pixels, picture.pixels);
  picture(0, 1) = -1.0f;
  write_float_image(directory / "a.npy", picture, "a", OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { read_ambient_scale(directory / "a.npy"); }),
              testing::EndsWith("a.npy: row 0, column 1: found -1; expected a finite number >= 0"));
}

}  // namespace
}  // namespace tofsmith
