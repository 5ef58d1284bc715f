// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/training_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "core/shared/text_numbers.hpp"
#include "io/shared/read_file.hpp"
#include "temporary_directory.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/npy.hpp"

namespace tofsmith {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The name of the scene is its distance.
LoadedTrainingScene wall(const TrainingScene& scene) {
  if (scene.name == "bad") throw IoError(scene.name, "is no scene");
  LoadedTrainingScene loaded{SceneImage(3, 4), PinholeView::centred(4, 3, 1.0)};
  loaded.image.depth_m = Image<float>(3, 4, static_cast<float>(number_in(scene.name).value()));
  return loaded;
}

std::vector<TrainingScene> walls(const std::vector<std::string>& names) {
  std::vector<TrainingScene> scenes;
  for (const std::string& name : names) scenes.push_back({name, name});
  return scenes;
}

const TrainingSetOptions dim = {.signal_range = {{1e5, 1e6}}, .ambient_range = {{1e4, 1e4}}};

TrainingSetRun write(const fs::path& directory, const std::vector<std::string>& names,
                     const TrainingSetOptions& options = dim) {
  const std::vector<std::string> settings = {"samples=24"};
  const Camera camera = load_camera("paper-10f0", settings);
  return write_training_set(directory, walls(names), load_code("hamiltonian-k3", camera), camera,
                            wall, options);
}

std::map<std::string, std::string> content_of(const fs::path& directory) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(directory))
    if (entry.is_regular_file())
      content[entry.path().lexically_relative(directory)] = read_text_file(entry.path());
  return content;
}

TEST(TrainingSet, IsIndependentOfOrderShardsAndThreads) {
  const TemporaryDirectory one, other, shards;
  EXPECT_EQ(write(one.path(), {"1", "2", "3", "4"}).written, 4);
  {
    const ThreadLimit limit(1);
    write(other.path(), {"2"});
    const TrainingSetRun run = write(other.path(), {"1", "2", "3", "4"});
    EXPECT_EQ(run.written, 3);
    EXPECT_EQ(run.kept, 1);
  }
  EXPECT_EQ(content_of(one.path()), content_of(other.path()));
  std::int64_t sum = 0;
  for (int i = 1; i <= 2; ++i) {
    TrainingSetOptions part = dim;
    part.shard = {i, 2};
    sum += write(shards.path(), {"4", "3", "2", "1"}, part).written;
  }
  EXPECT_EQ(sum, 4);
  EXPECT_EQ(write(shards.path(), {"1", "2", "3", "4"}).kept, 4);
  auto parts = content_of(shards.path());
  EXPECT_EQ(parts.erase("index-1-of-2.json") + parts.erase("index-2-of-2.json"), 2u);
  EXPECT_EQ(parts, content_of(one.path()));
}

TEST(TrainingSet, RepeatsIncompleteItems) {
  const TemporaryDirectory directory;
  write(directory.path(), {"1", "2"});
  const auto whole = content_of(directory.path());
  for (const auto& [name, content] : whole)
    if (name.ends_with(".json") && name.find('/') != std::string::npos) {
      fs::remove(directory / name);  // as if the process was killed between both files
      break;
    }
  const TrainingSetRun run = write(directory.path(), {"1", "2"});
  EXPECT_EQ(run.written, 1);
  EXPECT_EQ(content_of(directory.path()), whole);
}

TEST(TrainingSet, ContainsTheTrueDepthAndASimilarDecodedDepth) {
  const TemporaryDirectory directory;
  TrainingSetOptions bright = dim;
  bright.signal_range = {1e9, 1e9};
  write(directory.path(), {"2.5"}, bright);
  for (const auto& [name, content] : content_of(directory.path())) {
    if (!name.ends_with(".npz")) continue;
    const NpzArrays arrays = read_npz(directory / name);
    EXPECT_EQ(arrays.at("raw").shape(), (NpyShape{1, 3, 4, 3}));
    EXPECT_EQ(arrays.at("albedo").shape(), (NpyShape{3, 4}));
    for (const float depth_m : arrays.at("true_depth_m").as<float>()) EXPECT_EQ(depth_m, 2.5f);
    for (const float depth_m : arrays.at("depth_m").as<float>()) EXPECT_NEAR(depth_m, 2.5f, 0.1f);
  }
}

TEST(TrainingSet, OtherSettingsGiveOtherFiles) {
  const TemporaryDirectory directory;
  write(directory.path(), {"1"});
  std::vector<TrainingSetOptions> others(5, dim);
  others[0].capture.seed = 2;
  others[1].signal_range->high_e_per_s = 2e6;
  others[2].ambient_range = {2e4, 2e4};
  others[3].capture.falloff = false;
  others[4].capture.frames = 2;
  for (const TrainingSetOptions& other : others)
    EXPECT_EQ(write(directory.path(), {"1"}, other).written, 1);
  EXPECT_EQ(write(directory.path(), {"1"}).kept, 1);
}

TEST(TrainingSet, WithoutARangeTheLightIsThatOfTheCapture) {
  const TemporaryDirectory directory;
  write(directory.path(), {"1"});
  TrainingSetOptions fixed = dim;
  fixed.ambient_range.reset();
  fixed.capture.ambient_e_per_s = 1e4;
  EXPECT_EQ(write(directory.path(), {"1"}, fixed).kept, 1);
}

TEST(TrainingSet, AnInvalidSceneDoesNotAffectOthers) {
  const TemporaryDirectory directory;
  const TrainingSetRun run = write(directory.path(), {"1", "bad", "2"});
  EXPECT_EQ(run.written, 2);
  ASSERT_EQ(run.failures.size(), 1u);
  EXPECT_EQ(run.failures[0], "bad: is no scene");
}

TEST(TrainingSet, RejectsInvalidRanges) {
  const TemporaryDirectory directory;
  TrainingSetOptions bad = dim;
  bad.signal_range = {2.0, 1.0};
  EXPECT_THAT([&] { write(directory.path(), {"1"}, bad); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("signal_range = 2:1; must be low and high in e/s")));
  bad.signal_range = {0.0, 1.0};
  EXPECT_THAT([&] { write(directory.path(), {"1"}, bad); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("signal_range = 0:1")));
}

TEST(TrainingScenes, AreReadFromFoldersAndLists) {
  const TemporaryDirectory directory;
  fs::create_directories(directory / "f/g");
  for (const char* name : {"f/b.npy", "f/g/a.png", "f/notes.md"}) std::ofstream(directory / name);
  std::ofstream(directory / "list.txt") << "\xef\xbb\xbf# remark\n  f/b.npy \n\nx.exr\n";
  const auto names = [&](const std::vector<std::string>& inputs) {
    std::vector<std::string> found;
    for (const TrainingScene& scene : training_scenes(inputs)) found.push_back(scene.name);
    return found;
  };
  EXPECT_EQ(names({(directory / "f").string()}), (std::vector<std::string>{"b.npy", "g/a.png"}));
  EXPECT_EQ(names({(directory / "list.txt").string()}),
            (std::vector<std::string>{"f/b.npy", "x.exr"}));
  EXPECT_EQ(training_scenes(std::vector{(directory / "list.txt").string()})[1].file,
            directory / "x.exr");
  EXPECT_THAT(
      [&] {
        names({"a.npy", "a.npy"});
      },
      ThrowsMessage<IoError>(AllOf(HasSubstr("a.npy"), HasSubstr("twice"))));
  fs::create_directories(directory / "empty");
  EXPECT_THAT([&] { names({(directory / "empty").string()}); },
              ThrowsMessage<IoError>(HasSubstr("contains no scenes")));
}

}  // namespace
}  // namespace tofsmith
