// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/simulate/scene_result.hpp"

#include <gtest/gtest.h>

namespace tofsmith {
namespace {

TEST(SceneExtent, CountsReturnsAndWraps) {
  const Camera camera = built_in_camera("paper-10f0");  // 9.99 m
  SceneImage scene(1, 5);                               // no return
  scene.depth_m.pixels[1] = 2.0f;
  scene.depth_m.pixels[2] = 10.5f;
  scene.depth_m.pixels[4] = 9.0f;
  const SceneExtent extent = scene_extent(scene, camera);
  EXPECT_EQ(extent.pixels, 5);
  EXPECT_EQ(extent.returns, 3);
  EXPECT_EQ(extent.beyond_range, 1);
  EXPECT_DOUBLE_EQ(extent.no_return_share(), 0.4);
  EXPECT_DOUBLE_EQ(extent.beyond_range_share(), 1.0 / 3.0);
  EXPECT_EQ(extent.nearest_m, 2.0);
  EXPECT_EQ(extent.median_m, 9.0);
  EXPECT_EQ(extent.farthest_m, 10.5);
  EXPECT_EQ(beyond_range(scene, camera).pixels, (std::vector<std::uint8_t>{0, 0, 1, 0, 0}));
}

TEST(SceneExtent, OfAnEmptySceneIsZero) {
  const SceneExtent extent = scene_extent(SceneImage(2, 2), built_in_camera("paper-10f0"));
  EXPECT_EQ(extent.returns, 0);
  EXPECT_EQ(extent.farthest_m, 0.0);
  EXPECT_EQ(extent.no_return_share(), 1.0);
  EXPECT_EQ(extent.beyond_range_share(), 0.0);
}

}  // namespace
}  // namespace tofsmith
