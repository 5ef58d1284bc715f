// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/scene_toml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <limits>

#include "damaged_files.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"

namespace tofsmith {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

SceneResult scene() {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  SceneResult scene{.name = "a scene", .truth = SceneImage(2, 3)};
  scene.truth.depth_m.pixels = {1.0f, 2.0f, 3.0f, none, 4.0f, 5.0f};
  scene.truth.albedo.pixels = {0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f};
  scene.truth.cosine.pixels = {1.0f, 0.9f, 0.8f, 0.7f, 0.6f, 0.5f};
  scene.view = PinholeView::centred(3, 2, 1.0);
  scene.reference_distance_m = 2.5;
  const SceneError error{.mean_m = 0.1,
                         .median_m = 0.2,
                         .outlier_rate = 0.3,
                         .decoded_share = 0.4,
                         .pixels = 5,
                         .outlier_threshold_m = 0.6};
  for (const char* light : {"low", "high"}) {
    SceneCapture capture{light, {1e3, 1e4}, {}};
    for (const char* code : {"hamiltonian-k4", "../a/b \xc3\xbc"})
      capture.decodings.push_back({code, scene.truth.depth_m, error});
    capture.decodings.back().filtered = {scene.truth.depth_m, scene.truth.albedo, error};
    scene.captures.push_back(capture);
  }
  return scene;
}

void expect_same_image(const Image<float>& a, const Image<float>& b) {
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.width, b.width);
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(a.pixels[i]), std::bit_cast<std::uint32_t>(b.pixels[i]));
}

TEST(SceneDirectory, ReadingUndoesWriting) {
  const TemporaryDirectory place;
  EXPECT_FALSE(holds_scene_result(place / "scene"));
  write_scene_result(place / "scene", scene(), OutputPolicy::refuse_existing);
  EXPECT_TRUE(holds_scene_result(place / "scene"));
  EXPECT_EQ(place.files(), 1);
  const SceneResult read = read_scene_result(place / "scene"), written = scene();
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.reference_distance_m, written.reference_distance_m);
  EXPECT_EQ(read.view.fx_px, written.view.fx_px);
  EXPECT_EQ(read.view.cy_px, written.view.cy_px);
  EXPECT_EQ(read.view.width, 3);
  expect_same_image(read.truth.depth_m, written.truth.depth_m);
  expect_same_image(read.truth.albedo, written.truth.albedo);
  expect_same_image(read.truth.cosine, written.truth.cosine);
  ASSERT_EQ(read.captures.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(read.captures[c].light, written.captures[c].light);
    EXPECT_EQ(read.captures[c].point, written.captures[c].point);
    ASSERT_EQ(read.captures[c].decodings.size(), 2u);
    for (std::size_t d = 0; d < 2; ++d) {
      const SceneDecoding &a = read.captures[c].decodings[d], &b = written.captures[c].decodings[d];
      EXPECT_EQ(a.code, b.code);
      expect_same_image(a.depth_m, b.depth_m);
      EXPECT_EQ(a.error.mean_m, b.error.mean_m);
      EXPECT_EQ(a.error.median_m, b.error.median_m);
      EXPECT_EQ(a.error.outlier_rate, b.error.outlier_rate);
      EXPECT_EQ(a.error.decoded_share, b.error.decoded_share);
      ASSERT_EQ(a.filtered.has_value(), b.filtered.has_value());
      if (!a.filtered) continue;
      expect_same_image(a.filtered->depth_m, b.filtered->depth_m);
      expect_same_image(a.filtered->averaged, b.filtered->averaged);
      EXPECT_EQ(a.filtered->error.mean_m, b.filtered->error.mean_m);
      EXPECT_EQ(a.error.pixels, b.error.pixels);
      EXPECT_EQ(a.error.outlier_threshold_m, b.error.outlier_threshold_m);
    }
  }
}

/// Does not synchronize the disk, unlike an atomic file.
void overwrite(const fs::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

TEST(SceneDirectory, DamageIsReadOrRejectedWithTheFileName) {
  const TemporaryDirectory place;
  write_scene_result(place.path(), scene(), OutputPolicy::overwrite);
  for (const char* name : {"scene.json", "albedo.npy", "low-hamiltonian-k4.npy"}) {
    const FileBytes whole = read_binary_file(place / name);
    int refused = 0;
    const auto read = [&] {
      try {
        read_scene_result(place.path());
      } catch (const IoError& error) {
        ++refused;
        EXPECT_THAT(error.what(), HasSubstr(place.path().string()));
      }
    };
    for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 40) {
      overwrite(place / name, std::span(whole).first(length));
      EXPECT_NO_THROW(read()) << name << " cut after " << length;
    }
    EXPECT_GT(refused, 20) << name;
    for (std::uint64_t i = 0; i < 200; ++i) {
      RandomStream random(4, i);
      overwrite(place / name, damaged(whole, random));
      EXPECT_NO_THROW(read()) << name << " damaged, case " << i;
    }
    overwrite(place / name, whole);
  }
  EXPECT_NO_THROW(read_scene_result(place.path()));
}

TEST(SceneDirectory, RejectsPlanesOfAnotherSizeAndFilesElsewhere) {
  const TemporaryDirectory place;
  write_scene_result(place.path(), scene(), OutputPolicy::overwrite);
  SceneResult larger{.name = "larger", .truth = SceneImage(4, 4)};
  larger.view = PinholeView::centred(4, 4, 1.0);
  write_scene_result(place / "larger", larger, OutputPolicy::overwrite);
  fs::copy_file(place / "larger" / "albedo.npy", place / "low-hamiltonian-k4.npy",
                fs::copy_options::overwrite_existing);
  EXPECT_THAT(io_error_of([&] { read_scene_result(place.path()); }),
              HasSubstr("found 4 x 4 pixels; expected the 2 x 3"));
  std::string json = read_text_file(place / "scene.json");
  const std::string from = "\"low-hamiltonian-k4.npy\"";
  json.replace(json.find(from), from.size(), "\"../elsewhere.npy\"");
  write_file_atomically(place / "scene.json", json, OutputPolicy::overwrite);
  EXPECT_THAT(io_error_of([&] { read_scene_result(place.path()); }),
              HasSubstr("/captures/0/decodings/0/file"));
}

}  // namespace
}  // namespace tofsmith
