// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "io/images/exr.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "damaged_files.hpp"
#include "io/images/netpbm.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {

namespace {

using testing::HasSubstr;

ExrPlanes test_planes(int height = 5, int width = 6) {
  ExrPlanes planes;
  for (const char* name : {"Z", "confidence"}) {
    Image<float> plane(height, width);
    RandomStream random(6, planes.size());
    for (float& value : plane.pixels) value = static_cast<float>(random.normal());
    plane.pixels[2] = std::numeric_limits<float>::infinity();
    planes[name] = plane;
  }
  return planes;
}

TEST(Exr, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  for (const auto& [height, width] : {std::pair{1, 3}, std::pair{5, 6}, std::pair{70, 33}}) {
    const ExrPlanes planes = test_planes(height, width);
    write_exr(directory / "a.exr", planes, OutputPolicy::overwrite);
    const ExrPlanes back = read_exr(directory / "a.exr");
    ASSERT_EQ(back.size(), 2u);
    for (const auto& [name, plane] : planes) {
      EXPECT_EQ(back.at(name).height, height);
      EXPECT_EQ(back.at(name).width, width);
      EXPECT_EQ(back.at(name).pixels, plane.pixels);
    }
  }
}

TEST(Exr, EqualPlanesGiveEqualBytes) {
  EXPECT_EQ(serialize_exr(test_planes()), serialize_exr(test_planes()));
}

std::string attribute(std::string name, std::string kind, const std::string& value) {
  std::string size(4, '\0');
  size[0] = static_cast<char>(value.size());
  return name + '\0' + kind + '\0' + size + value;
}

/// Returns an uncompressed file of one line with two half-float pixels, 1.0 and -2.0. `type` is the
/// pixel type, `flags` the second version byte, and `more` is appended to the attributes.
FileBytes small_file(char type = 1, char flags = 0,
                     const std::string& window_corner = std::string("\1\0\0\0\0\0\0\0", 8),
                     const std::string& more = "") {
  const std::string window = std::string(8, '\0') + window_corner;
  std::string file = std::string("\x76\x2f\x31\x01\x02", 5) + flags + std::string(2, '\0');
  file +=
      attribute("channels", "chlist",
                std::string("Z\0", 2) + type + std::string("\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0", 16));
  file += attribute("compression", "compression", std::string(1, '\0'));
  file += attribute("dataWindow", "box2i", window);
  file += attribute("displayWindow", "box2i", window);
  file += attribute("lineOrder", "lineOrder", std::string(1, '\0'));
  file += attribute("pixelAspectRatio", "float", std::string("\0\0\x80\x3f", 4));
  file += attribute("screenWindowCenter", "v2f", std::string(8, '\0'));
  file += attribute("screenWindowWidth", "float", std::string("\0\0\x80\x3f", 4));
  file += more + '\0';
  const std::size_t offset = file.size() + 8;
  file += static_cast<char>(offset & 0xff);
  file += static_cast<char>(offset >> 8);
  file += std::string(6, '\0');                // offset of the only line
  file += std::string("\0\0\0\0\4\0\0\0", 8);  // its row and length
  file += std::string("\x00\x3c\x00\xc0", 4);  // 1.0, -2.0
  return bytes_of(file);
}

TEST(Exr, ReadsHalfFloats) {
  const ExrPlanes planes = parse_exr(small_file(), "a.exr");
  EXPECT_THAT(planes.at("Z").pixels, testing::ElementsAre(1.0f, -2.0f));
}

TEST(Exr, RejectsUnsupportedFiles) {
  const auto refusal = [](const FileBytes& file) {
    return io_error_of([&] { parse_exr(file, "a.exr"); });
  };
  EXPECT_THAT(refusal(bytes_of("PNG and more")),
              HasSubstr("a.exr: byte 0: found no OpenEXR magic"));
  EXPECT_THAT(refusal(small_file(0)), HasSubstr("channel 'Z' holds integers"));
  EXPECT_THAT(refusal(small_file(1, 0x08)), HasSubstr("deep"));
  EXPECT_THAT(refusal(small_file(1, 0x10)), HasSubstr("several parts"));
  EXPECT_THAT(refusal(small_file(1, 0x40)), HasSubstr("unknown flags"));
  EXPECT_THAT(refusal(small_file(1, 0, "\xff\xff\xff\x7f\xff\xff\xff\x7f")), HasSubstr("at most"));
  EXPECT_THAT(refusal(small_file(1, 0, std::string("\0\x1f\0\0\0\x1f\0\0", 8))),
              HasSubstr("can unpack to"));
  EXPECT_THAT(refusal(small_file(1, 0, "\xf0\xff\xff\xff\xff\xff\xff\xff")),
              HasSubstr("found an image"));
}

// The OpenEXR library assumes that attributes are as long as their types: other sizes made it
// misinterpret the following bytes and allocate gigabytes for a file of 600 bytes.
TEST(Exr, RejectsAttributesOfOtherSizesThanTheirTypes) {
  const auto parse = [](const std::string& type, const std::string& value) {
    parse_exr(small_file(1, 0, std::string("\1\0\0\0\0\0\0\0", 8), attribute("a", type, value)),
              "a.exr");
  };
  const auto refusal = [&](const std::string& type, const std::string& value) {
    return io_error_of([&] { parse(type, value); });
  };
  EXPECT_THAT(refusal("v3f", std::string(8, '\0')), HasSubstr("found 8 bytes of type 'v3f'"));
  EXPECT_THAT(refusal("box2i", std::string(20, '\0')), HasSubstr("expected 16"));
  EXPECT_THAT(refusal("preview", std::string("\1\0\0\0\xff\xff\xff\xff", 8)),
              HasSubstr("type 'preview'"));
  EXPECT_THAT(refusal("chlist", std::string(3, '\0')), HasSubstr("expected 1"));
  for (const char* any : {"string", "ours"}) EXPECT_NO_THROW(parse(any, "some words"));
}

TEST(Exr, RefusesEveryTruncation) {
  const FileParser parse = [](auto bytes) { parse_exr(bytes, "a.exr"); };
  expect_truncations_refused(small_file(), parse);
  expect_truncations_refused(serialize_exr(test_planes()), parse);
}

TEST(Exr, RejectsWritingPlanesOfDifferentSizes) {
  EXPECT_THROW(serialize_exr({}), std::invalid_argument);
  EXPECT_THROW(serialize_exr({{"", Image<float>(1, 1)}}), std::invalid_argument);
  EXPECT_THROW(serialize_exr({{"Z", Image<float>()}}), std::invalid_argument);
  EXPECT_THROW(serialize_exr({{"Y", Image<float>(1, 2)}, {"Z", Image<float>(2, 1)}}),
               std::invalid_argument);
}

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

TEST(MultipathFile, WrittenReturnsAreReadBack) {
  SceneImage scene(1, 3);
  scene.depth_m.pixels = {1.0f, 2.0f, 3.0f};
  SceneLight light;
  light.returns = MultipathReturns(1, 3);
  const std::vector<MultipathReturn> two = {{1.5f, 0.5f}, {2.25f, 0.125f}}, one = {{3.0f, 0.0f}};
  light.returns.append_pixel(two);
  light.returns.append_pixel({});
  light.returns.append_pixel(one);
  const TemporaryDirectory directory;
  const auto path = directory / "truth.npz";
  write_multipath_truth(path, multipath_truth(scene, light, {}), light,
                        OutputPolicy::refuse_existing);
  const MultipathReturns read = read_multipath_returns(path, 1, 3);
  EXPECT_EQ(read.first, light.returns.first);
  ASSERT_EQ(read.returns.size(), light.returns.returns.size());
  for (std::size_t i = 0; i < read.returns.size(); ++i) {
    EXPECT_EQ(read.returns[i].distance_m, light.returns.returns[i].distance_m);
    EXPECT_EQ(read.returns[i].ratio, light.returns.returns[i].ratio);
  }
  read.validate(scene, 10.0);
}

TEST(MultipathFile, RejectsListsThatDoNotMatchTheScene) {
  const TemporaryDirectory directory;
  const auto refuses = [&](const std::vector<double>& first, const std::vector<float>& distance_m,
                           const std::vector<float>& ratio, const char* words) {
    const auto path = directory / "returns.npz";
    NpzArrays arrays;
    arrays.emplace("first", NpyArray::of<double>({first.size()}, first));
    arrays.emplace("distance_m", NpyArray::of<float>({distance_m.size()}, distance_m));
    arrays.emplace("ratio", NpyArray::of<float>({ratio.size()}, ratio));
    write_npz(path, arrays, overwrite);
    EXPECT_THAT(io_error_of([&] { read_multipath_returns(path, 1, 2); }), HasSubstr(words));
  };
  refuses({0, 1}, {1.0f}, {0.1f}, "found 2 entries; expected 3");
  refuses({0, 1, 1}, {1.0f}, {}, "found 0 entries; expected 1");
  refuses({0, 0.5, 1}, {1.0f}, {0.1f}, "entry 1: found 0.5; expected a whole number in [0, 1]");
  refuses({0, 1, 4}, {1.0f}, {0.1f}, "entry 2: found 4");
}

}  // namespace

}  // namespace tofsmith
