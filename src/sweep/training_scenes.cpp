// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/shared/read_file.hpp"
#include "io/text/shared/line_cursor.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/sweep/training_set.hpp"

namespace tofsmith {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> scene_extensions = {
    ".npy", ".npz", ".exr", ".pfm", ".png", ".toml", ".obj", ".ply", ".stl"};

bool can_be_scene(const fs::path& path) {
  return std::ranges::find(scene_extensions, path.extension().string()) != scene_extensions.end();
}

void add_folder(std::vector<TrainingScene>& scenes, const fs::path& folder) {
  const std::size_t before = scenes.size();
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file() && can_be_scene(entry.path()))
        scenes.push_back({entry.path().lexically_relative(folder).generic_string(), entry.path()});
  } catch (const fs::filesystem_error& error) {
    throw IoError(folder.string(), fmt::format("cannot be read: {}", error.code().message()));
  }
  if (scenes.size() == before)
    throw IoError(folder.string(), fmt::format("contains no scenes; expected files of {}",
                                               fmt::join(scene_extensions, ", ")));
}

void add_list(std::vector<TrainingScene>& scenes, const fs::path& list) {
  const std::size_t before = scenes.size();
  const std::string text = read_text_file(list);
  for (const TextLine& line : content_lines(text)) {
    const std::string name(trimmed(line.text));
    scenes.push_back({name, list.parent_path() / name});
  }
  if (scenes.size() == before)
    throw IoError(list.string(), "contains no scenes; expected one per line");
}

}  // namespace

std::vector<TrainingScene> training_scenes(std::span<const std::string> inputs) {
  std::vector<TrainingScene> scenes;
  for (const std::string& input : inputs) {
    std::error_code ignored;
    if (fs::is_directory(input, ignored))
      add_folder(scenes, input);
    else if (fs::path(input).extension() == ".txt")
      add_list(scenes, input);
    else
      scenes.push_back({input, input});
  }
  std::ranges::sort(scenes, {}, &TrainingScene::name);
  const auto twice = std::ranges::adjacent_find(scenes, {}, &TrainingScene::name);
  if (twice != scenes.end())
    throw IoError(twice->file.string(),
                  fmt::format("found the name {} twice ({} is the other); expected different "
                              "names, because the noise of a scene depends on its name",
                              twice->name, std::next(twice)->file.string()));
  return scenes;
}

}  // namespace tofsmith
