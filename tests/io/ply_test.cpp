// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "damaged_files.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PointCloud test_cloud() {
  PointCloud cloud;
  cloud.points_m = {{1.0f, 2.0f, 3.0f}, {-1.5f, 0.0f, 1e-3f}};
  cloud.scalars = {{"intensity", {0.25f, 4.0f}}, {"confidence", {1.0f, 0.5f}}};
  cloud.colours = {{0, 128, 255}, {1, 2, 3}};
  return cloud;
}

void expect_same(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.points_m, b.points_m);
  EXPECT_EQ(a.colours, b.colours);
  ASSERT_EQ(a.scalars.size(), b.scalars.size());
  for (std::size_t i = 0; i < a.scalars.size(); ++i) {
    EXPECT_EQ(a.scalars[i].name, b.scalars[i].name);
    EXPECT_EQ(a.scalars[i].values, b.scalars[i].values);
  }
}

const std::string ascii_file =
    "ply\nformat ascii 1.0\ncomment two points\nelement vertex 2\nproperty float x\n"
    "property float y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nproperty float intensity\nproperty float confidence\nend_header\n"
    "1 2 3 0 128 255 0.25 1\n-1.5 0 1e-3 1 2 3 4 0.5\n";

TEST(Ply, ReadingUndoesWriting) {
  const TemporaryDirectory directory;
  write_ply(directory / "a.ply", test_cloud(), OutputPolicy::refuse_existing);
  expect_same(read_ply(directory / "a.ply"), test_cloud());

  PointCloud bare;
  bare.points_m = {{1.0f, 2.0f, 3.0f}};
  expect_same(parse_ply(serialize_ply(bare), "a.ply"), bare);
  expect_same(parse_ply(serialize_ply(PointCloud{}), "a.ply"), PointCloud{});
}

TEST(Ply, TheFileIsTheOneTheFormatAsksFor) {
  PointCloud cloud;
  cloud.points_m = {{1.0f, -2.0f, 0.0f}};
  cloud.scalars = {{"intensity", {0.5f}}};
  cloud.colours = {{1, 2, 255}};
  EXPECT_EQ(serialize_ply(cloud),
            bytes_of(std::string("ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property float intensity\nproperty uchar red\n"
                                 "property uchar green\nproperty uchar blue\nend_header\n") +
                     std::string("\0\0\x80\x3f\0\0\0\xc0\0\0\0\0\0\0\0\x3f\1\2\xff", 19)));
}

TEST(Ply, AsciiAndBinaryAgree) {
  expect_same(parse_ply(bytes_of(ascii_file), "a.ply"), test_cloud());
}

TEST(Ply, ReadsEveryNumberType) {
  const std::string file =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\nproperty char x\r\n"
      "property short y\r\nproperty int z\r\nproperty uchar a\r\nproperty ushort b\r\n"
      "property uint c\r\nproperty double d\r\nend_header\r\n" +
      std::string("\xff\xfe\xff\xfd\xff\xff\xff\xff\xff\xff\0\0\0\x80\0\0\0\0\0\0\x04\xc0", 22);
  const PointCloud cloud = parse_ply(bytes_of(file), "a.ply");
  EXPECT_THAT(cloud.points_m[0], ElementsAre(-1.0f, -2.0f, -3.0f));
  EXPECT_EQ(cloud.scalars[0].values[0], 255.0f);
  EXPECT_EQ(cloud.scalars[1].values[0], 65535.0f);
  EXPECT_EQ(cloud.scalars[2].values[0], 2147483648.0f);
  EXPECT_EQ(cloud.scalars[3].values[0], -2.5f);
}

TEST(Ply, RefusesWhatItDoesNotReadAtAByte) {
  const auto refusal = [](const std::string& text) {
    return io_error_of([&] { parse_ply(bytes_of(text), "a.ply"); });
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string start = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(refusal("off\n"), HasSubstr("a.ply: byte 0: found no PLY magic"));
  EXPECT_THAT(refusal("ply\nformat binary_big_endian 1.0\n"), HasSubstr("a.ply: byte 4: expected"));
  EXPECT_THAT(refusal(start + "element face 1\n"), HasSubstr("byte 21"));
  EXPECT_THAT(refusal(start + "element vertex -1\n"), HasSubstr("integer >= 0"));
  EXPECT_THAT(refusal(start + "element vertex 1\nproperty list uchar int x\n"), HasSubstr("list"));
  EXPECT_THAT(refusal(start + "element vertex 1\nproperty half x\n"), HasSubstr("types"));
  EXPECT_THAT(refusal(start + "element vertex 1\nelement face 1\n"), HasSubstr("second element"));
  EXPECT_THAT(refusal(start + "element vertex 1\nproperty float x\nend_header\n1\n"),
              HasSubstr("x, y and z"));
  EXPECT_THAT(refusal(start + "property float x\n"), HasSubstr("element vertex"));
  EXPECT_THAT(refusal("ply\nelement vertex 0\n" + xyz + "end_header\n"), HasSubstr("format"));
  EXPECT_THAT(refusal(start + "element vertex 1\n" + xyz + "end_header\n1 2 a\n"),
              HasSubstr("a vertex of 3 numbers"));
  EXPECT_THAT(refusal(start + "element vertex 1\n" + xyz + "end_header\n1 2 3 4\n"),
              HasSubstr("more than 3 numbers"));
  EXPECT_THAT(refusal(start + "element vertex 1\n" + xyz + "end_header\n1 2 3\n4 5 6\n"),
              HasSubstr("after the last vertex"));
  EXPECT_THAT(refusal(start + "element vertex 9999999999999\n" + xyz + "end_header\n1 2 3\n"),
              HasSubstr("found 6 bytes of data"));
}

TEST(Ply, RefusesEveryTruncation) {
  const FileParser parse = [](auto bytes) { parse_ply(bytes, "a.ply"); };
  expect_truncations_refused(serialize_ply(test_cloud()), parse);
  expect_truncations_refused(bytes_of(ascii_file), parse);
}

TEST(Ply, DamagedFilesAreReadOrRefused) {
  const FileParser parse = [](auto bytes) { parse_ply(bytes, "a.ply"); };
  EXPECT_GT(expect_damage_read_or_refused(serialize_ply(test_cloud()), 3000, 9, parse), 1000);
  EXPECT_GT(expect_damage_read_or_refused(bytes_of(ascii_file), 3000, 10, parse), 1000);
}

TEST(Ply, RefusesToWriteCloudsThatAreNone) {
  PointCloud cloud = test_cloud();
  cloud.colours.pop_back();
  EXPECT_THROW(serialize_ply(cloud), std::invalid_argument);
  for (const char* name : {"x", "red", "confidence", "two words", ""}) {
    cloud = test_cloud();
    cloud.scalars[0].name = name;
    EXPECT_THROW(serialize_ply(cloud), std::invalid_argument) << name;
  }
  cloud = test_cloud();
  cloud.scalars[1].values.push_back(1.0f);
  EXPECT_THROW(serialize_ply(cloud), std::invalid_argument);
}

}  // namespace
}  // namespace tofsmith
