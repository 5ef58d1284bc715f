// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/depth_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "damaged_files.hpp"
#include "io/images/exr.hpp"
#include "io/images/pfm.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float float_infinity = std::numeric_limits<float>::infinity();
constexpr auto overwrite = OutputPolicy::overwrite;

Image<float> image_of(int height, int width, std::vector<float> pixels) {
  Image<float> image(height, width);
  image.pixels = std::move(pixels);
  return image;
}

void expect_same(const Image<float>& a, const Image<float>& b) {
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.width, b.width);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool same =
        a.pixels[i] == b.pixels[i] || (std::isnan(a.pixels[i]) && std::isnan(b.pixels[i]));
    EXPECT_TRUE(same) << "pixel " << i << ": " << a.pixels[i] << " and " << b.pixels[i];
  }
}

std::string read_refusal(const std::filesystem::path& path) {
  return io_error_of([&] { read_depth(path); });
}

class DepthFormat : public testing::TestWithParam<std::string> {
 protected:
  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / ("depth" + GetParam());
};

TEST_P(DepthFormat, StatesWhetherDepthIsRadialOrZWhereItCan) {
  const bool states_kind = GetParam() != ".npy" && GetParam() != ".pfm";
  for (const DepthKind kind : {DepthKind::radial, DepthKind::z}) {
    write_depth(file_, image_of(1, 2, {1.0f, 2.0f}), overwrite, kind);
    EXPECT_EQ(stored_depth_kind(file_), states_kind ? std::optional(kind) : std::nullopt);
    EXPECT_EQ(depth_kind_of(file_, {}, DepthKind::z), states_kind ? kind : DepthKind::z);
    EXPECT_EQ(depth_kind_of(file_, kind, DepthKind::z), kind);
  }
  if (states_kind) {
    EXPECT_THAT(io_error_of([&] { depth_kind_of(file_, DepthKind::radial, DepthKind::radial); }),
                HasSubstr("states that its depth is of kind z; expected radial"));
  }
}

TEST_P(DepthFormat, ReadingUndoesWriting) {
  // Whole millimetres, which every format represents exactly.
  const auto depth_m = image_of(2, 3, {0.001f, 1.0f, 2.5f, 65.535f, nan, 0.125f});
  write_depth(file_, depth_m, OutputPolicy::refuse_existing);
  expect_same(read_depth(file_), depth_m);
}

TEST_P(DepthFormat, PixelsWithoutReturnAreNaN) {
  write_depth(file_, image_of(1, 4, {0.0f, float_infinity, nan, 2.0f}), overwrite);
  expect_same(read_depth(file_), image_of(1, 4, {nan, nan, nan, 2.0f}));
}

TEST_P(DepthFormat, DoesNotReplaceAFile) {
  const auto depth_m = image_of(1, 1, {1.0f});
  write_depth(file_, depth_m, OutputPolicy::refuse_existing);
  EXPECT_THAT(io_error_of([&] { write_depth(file_, depth_m, OutputPolicy::refuse_existing); }),
              HasSubstr("--force"));
}

TEST_P(DepthFormat, RejectsMissingAndEmptyFiles) {
  EXPECT_THAT(read_refusal(file_), HasSubstr("there is no such file"));
  write_file_atomically(file_, std::string_view(), overwrite);
  EXPECT_THAT(read_refusal(file_), HasSubstr(file_.string()));
}

INSTANTIATE_TEST_SUITE_P(All, DepthFormat,
                         testing::Values(".npy", ".npz", ".exr", ".pfm", ".png", ".PNG"));

class FloatFormat : public testing::TestWithParam<std::string> {};

TEST_P(FloatFormat, KeepsEveryBitOfFloatImages) {
  const TemporaryDirectory directory;
  const auto image = image_of(2, 2, {0.0f, -0.25f, float_infinity, nan});
  write_float_image(directory / ("a" + GetParam()), image, "offset", overwrite);
  const Image<float> back = read_float_image(directory / ("a" + GetParam()), "offset");
  EXPECT_EQ(std::memcmp(back.pixels.data(), image.pixels.data(), 16), 0);
}

INSTANTIATE_TEST_SUITE_P(All, FloatFormat, testing::Values(".npy", ".npz", ".exr", ".pfm"));

TEST(DepthFile, PngRoundsToTheNearestMillimetre) {
  const TemporaryDirectory directory;
  write_depth(directory / "a.png", image_of(1, 4, {1.2344f, 1.2346f, -0.0004f, 65.5354f}),
              overwrite);
  EXPECT_THAT(read_png(directory / "a.png").values, testing::ElementsAre(1234, 1235, 0, 65535));
}

TEST(DepthFile, PngRejectsUnrepresentableDepths) {
  const TemporaryDirectory directory;
  for (const float depth_m : {65.536f, 1e30f, -0.001f})
    EXPECT_THAT(io_error_of([&] {
                  write_depth(directory / "a.png", image_of(2, 2, {1, 1, 1, depth_m}), overwrite);
                }),
                HasSubstr("row 1, column 1"));
  EXPECT_EQ(directory.files(), 0);
}

TEST(DepthFile, RejectsUnknownExtensionsAndListsTheKnownOnes) {
  const TemporaryDirectory directory;
  EXPECT_THAT(
      read_refusal(directory / "a.tiff"),
      HasSubstr("found the extension '.tiff'; expected one of .npy, .npz, .exr, .pfm, .png"));
  EXPECT_THAT(io_error_of([&] { write_depth(directory / "a", image_of(1, 1, {1}), overwrite); }),
              HasSubstr("found no extension"));
  EXPECT_THAT(io_error_of([&] { read_float_image(directory / "a.png", "offset"); }),
              HasSubstr("expected one of .npy, .npz, .exr, .pfm"));
  EXPECT_THROW(write_depth(directory / "a.npy", Image<float>(), overwrite), std::invalid_argument);
  EXPECT_THROW(write_depth(directory / "a.png", Image<float>(), overwrite), std::invalid_argument);
}

TEST(DepthFile, RejectsArraysThatAreNotDepthImages) {
  const TemporaryDirectory directory;
  write_npy(directory / "a.npy", NpyArray(NpyType::float32, {2, 3, 4}), overwrite);
  EXPECT_THAT(read_refusal(directory / "a.npy"), HasSubstr("shape (2, 3, 4); expected (H, W)"));
  write_npy(directory / "a.npy", NpyArray(NpyType::uint16, {2, 3}), overwrite);
  EXPECT_THAT(read_refusal(directory / "a.npy"),
              HasSubstr("type uint16; expected float16, float32 or float64"));
  write_npy(directory / "a.npy", NpyArray(NpyType::float32, {2, 0}), overwrite);
  EXPECT_THAT(read_refusal(directory / "a.npy"), HasSubstr("2 x 0 pixels"));
  write_npy(directory / "a.npy", NpyArray(NpyType::float32, {1, 70000}), overwrite);
  EXPECT_THAT(read_refusal(directory / "a.npy"), HasSubstr("1 x 70000 pixels"));
}

TEST(DepthFile, ReadsHalfPrecision) {
  const TemporaryDirectory directory;
  NpyArray halves(NpyType::float16, {1, 3});
  const std::uint16_t bits[] = {0x3e00, 0x0001, 0x7c00};  // 1.5, 2^-24, infinity
  std::memcpy(halves.bytes().data(), bits, sizeof(bits));
  write_npy(directory / "a.npy", halves, overwrite);
  write_npz(directory / "a.npz", {{"depth", halves}}, overwrite);
  for (const char* file : {"a.npy", "a.npz"})
    expect_same(read_depth(directory / file), image_of(1, 3, {1.5f, 0x1p-24f, nan}));
}

TEST(DepthFile, UsesTheArrayNamedDepthOrTheOnlyOne) {
  const TemporaryDirectory directory;
  const NpyArray two(NpyType::float64, {1, 2}), three(NpyType::float64, {1, 3});
  write_npz(directory / "a.npz", {{"depth", two}, {"albedo", three}}, overwrite);
  EXPECT_EQ(read_depth(directory / "a.npz").width, 2);
  write_npz(directory / "a.npz", {{"other", three}}, overwrite);
  EXPECT_EQ(read_depth(directory / "a.npz").width, 3);
  write_npz(directory / "a.npz", {{"a", two}, {"b", three}}, overwrite);
  EXPECT_THAT(read_refusal(directory / "a.npz"),
              HasSubstr("found the arrays a, b; expected one called 'depth', or only one"));
}

TEST(DepthFile, UsesTheCommonExrChannels) {
  const TemporaryDirectory directory;
  const auto near = image_of(1, 1, {1.0f}), far = image_of(1, 1, {9.0f});
  const auto depth_of = [&](const ExrPlanes& planes) {
    write_exr(directory / "a.exr", planes, overwrite);
    return read_depth(directory / "a.exr").pixels[0];
  };
  EXPECT_EQ(depth_of({{"depth", near}, {"Z", far}, {"Y", far}}), 1.0f);
  EXPECT_EQ(depth_of({{"Z", near}, {"Y", far}, {"A", far}}), 1.0f);
  EXPECT_EQ(depth_of({{"Y", near}, {"A", far}}), 1.0f);
  EXPECT_EQ(depth_of({{"distance", near}}), 1.0f);
  EXPECT_EQ(depth_of({{"R", near}, {"G", near}, {"B", near}, {"A", far}}), 1.0f);
  write_exr(directory / "a.exr", {{"R", near}, {"G", near}, {"B", far}}, overwrite);
  EXPECT_THAT(read_refusal(directory / "a.exr"), HasSubstr("found the channels B, G, R"));
  write_depth(directory / "z.exr", near, overwrite);
  EXPECT_TRUE(read_exr(directory / "z.exr").contains("Z"));
}

TEST(DepthFile, RejectsColourAndEightBitImages) {
  const TemporaryDirectory directory;
  write_png(directory / "a.png", PngImage{1, 1, 1, 8, {1}}, overwrite);
  EXPECT_THAT(read_refusal(directory / "a.png"), HasSubstr("expected 16-bit grey"));
  write_png(directory / "a.png", PngImage{1, 1, 3, 16, {1, 2, 3}}, overwrite);
  EXPECT_THAT(read_refusal(directory / "a.png"), HasSubstr("found 3 channels of 16 bits"));
  write_pfm(directory / "a.pfm", PfmImage{1, 1, 3, 1.0, {1, 2, 3}}, overwrite);
  EXPECT_THAT(read_refusal(directory / "a.pfm"), HasSubstr("colour"));
}

}  // namespace
}  // namespace tofsmith
