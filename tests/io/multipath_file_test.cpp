// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/io/depth_file.hpp"

#include <gmock/gmock.h>

#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

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
    write_npz(path, arrays, OutputPolicy::overwrite);
    EXPECT_THAT([&] { read_multipath_returns(path, 1, 2); },
                testing::ThrowsMessage<IoError>(testing::HasSubstr(words)));
  };
  refuses({0, 1}, {1.0f}, {0.1f}, "found 2 entries; expected 3");
  refuses({0, 1, 1}, {1.0f}, {}, "found 0 entries; expected 1");
  refuses({0, 0.5, 1}, {1.0f}, {0.1f}, "entry 1: found 0.5; expected a whole number in [0, 1]");
  refuses({0, 1, 4}, {1.0f}, {0.1f}, "entry 2: found 4");
}

}  // namespace
}  // namespace tofsmith
