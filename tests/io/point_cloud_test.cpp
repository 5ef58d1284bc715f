// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/point_cloud.hpp"

#include <gtest/gtest.h>

#include "damaged_files.hpp"

namespace tofsmith {
namespace {

PointCloud test_cloud() {
  PointCloud cloud;
  cloud.points_m = {{1.0f, 2.0f, 3.0f}, {-1.5f, 0.0f, 1e-3f}};
  cloud.scalars = {{"intensity", {0.25f, 4.0f}}, {"confidence", {1.0f, 0.5f}}};
  cloud.colours = {{0, 128, 255}, {1, 2, 3}};
  return cloud;
}

TEST(PointCloud, TheFileFollowsTheFormat) {
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

TEST(PointCloud, RejectsWritingInvalidClouds) {
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
