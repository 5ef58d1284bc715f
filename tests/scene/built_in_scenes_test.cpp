// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/scene/built_in_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tofsmith/scene/ray_caster.hpp"

namespace tofsmith {
namespace {

struct Seen {
  StagedScene staged;
  SeenScene scene;
};

Seen see(std::string_view name) {
  StagedScene staged = built_in_scene(name, 161, 121);
  SeenScene scene = RayCaster(staged.shapes).see(staged.view, staged.camera_to_world);
  return {std::move(staged), std::move(scene)};
}

/// Calls `look(row, column)` for every pixel that sees the shape.
template <typename Look>
int pixels_of(const Seen& seen, std::int32_t shape, Look&& look) {
  int count = 0;
  for (int row = 0; row < seen.staged.view.height; ++row)
    for (int column = 0; column < seen.staged.view.width; ++column)
      if (seen.scene.shape(row, column) == shape) ++count, look(row, column);
  return count;
}

TEST(BuiltInScenes, AreValid) {
  for (const std::string& name : built_in_scene_names()) {
    const Seen seen = see(name);
    EXPECT_EQ(seen.scene.image.width(), 161) << name;
    seen.scene.image.validate();
    check_view(seen.staged, seen.scene.image);
  }
}

TEST(BuiltInScenes, UnknownNamesSuggestTheNearest) {
  try {
    built_in_scene("bokos", 8, 8);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "scene = bokos; must be one of table-top books ball wall corner room hand "
                 "moving-hand; did you mean "
                 "books?");
  }
  EXPECT_THROW(built_in_scene("wall", 0, 8), std::invalid_argument);
}

TEST(BuiltInScenes, BooksAre20CmApartAndTheWallIs2MetresBehindTheFirst) {
  const Seen seen = see("books");
  const auto depth = z_from_radial(seen.scene.image.depth_m, seen.staged.view);
  double last_column = -1.0;
  for (std::int32_t book = 0; book < 3; ++book) {
    double front_m = std::numeric_limits<double>::infinity(), column_sum = 0.0;
    const int count = pixels_of(seen, book, [&](int row, int column) {
      front_m = std::min<double>(front_m, depth(row, column));
      column_sum += column;
      EXPECT_EQ(seen.scene.image.albedo(row, column) <= 0.1f, book == 0) << "the first is dark";
    });
    EXPECT_GT(count, 500);
    EXPECT_NEAR(front_m, 1.2 + 0.2 * book, 1e-6);
    EXPECT_GT(column_sum / count, last_column) << "from left to right";
    last_column = column_sum / count;
  }
  EXPECT_GT(
      pixels_of(seen, 3, [&](int row, int column) { EXPECT_NEAR(depth(row, column), 3.2, 1e-6); }),
      2000);
}

TEST(BuiltInScenes, BallOf20CmRadiusAtOneMetre) {
  const Seen seen = see("ball");
  double nearest_m = std::numeric_limits<double>::infinity();
  float darkest = 1.0f, brightest = 0.0f;
  const int count = pixels_of(seen, 0, [&](int row, int column) {
    const double depth_m = seen.scene.image.depth_m(row, column);
    nearest_m = std::min(nearest_m, depth_m);
    const Eigen::Vector3d at = depth_m * seen.staged.view.ray(row, column);
    EXPECT_NEAR((at - Eigen::Vector3d(0, 0, 1)).norm(), 0.20, 1e-5);
    darkest = std::min(darkest, seen.scene.image.albedo(row, column));
    brightest = std::max(brightest, seen.scene.image.albedo(row, column));
  });
  EXPECT_NEAR(nearest_m, 0.80, 1e-6);
  EXPECT_GT(count, 161 * 121 / 4);
  EXPECT_LT(darkest, 0.3f) << "seams";
  EXPECT_GT(brightest, 0.8f) << "panels";
}

TEST(BuiltInScenes, WallFacesTheCameraAtHalfAMetre) {
  const Seen seen = see("wall");
  const auto depth = z_from_radial(seen.scene.image.depth_m, seen.staged.view);
  EXPECT_EQ(
      pixels_of(seen, 0, [&](int row, int column) { EXPECT_NEAR(depth(row, column), 0.5, 1e-6); }),
      161 * 121);
}

TEST(BuiltInScenes, HandHasFiveFingersAboutHalfAMetreAway) {
  const Seen seen = see("hand");
  const auto fingers_in_row = [&](int row) {
    int runs = 0;
    for (int column = 1; column < 161; ++column)
      runs += seen.scene.shape(row, column) >= 0 && seen.scene.shape(row, column - 1) < 0;
    return runs;
  };
  int most = 0, top = 121;
  for (int row = 120; row >= 0; --row) {
    most = std::max(most, fingers_in_row(row));
    if (fingers_in_row(row) > 0) top = row;
  }
  EXPECT_EQ(most, 5) << "a row across all fingers, the thumb among them";
  EXPECT_EQ(fingers_in_row(120), 1) << "the forearm leaves the picture below";
  EXPECT_GT(top, 0) << "the middle finger's tip is in the picture";
  double nearest_m = 10.0, farthest_m = 0.0;
  int returns = 0;
  for (const float depth : seen.scene.image.depth_m.pixels)
    if (std::isfinite(depth)) {
      ++returns;
      nearest_m = std::min<double>(nearest_m, depth);
      farthest_m = std::max<double>(farthest_m, depth);
    }
  EXPECT_GT(nearest_m, 0.44);
  EXPECT_LT(farthest_m, 0.56);
  EXPECT_GT(returns, 161 * 121 / 8);
  EXPECT_LT(returns, 161 * 121 / 2) << "no background";
}

}  // namespace
}  // namespace tofsmith
