// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// Writes a scene and its decodings into a directory:
///   scene.json                what is there, with the errors
///   true_depth.npy, albedo.npy, cosine.npy
///   LIGHT-CODE.npy            decoded depth [m], of file_name_of() their names
/// What scales ambient light, if anything does, is not kept.
/// @throws IoError
void write_scene_result(const std::filesystem::path& directory, const SceneResult& scene,
                        OutputPolicy policy);

/// Whether write_scene_result() has finished here.
bool holds_scene_result(const std::filesystem::path& directory);

/// @throws IoError naming the file and what is wrong with it
SceneResult read_scene_result(const std::filesystem::path& directory);

/// A finished design and the scene it was tried on, if there is one.
struct DesignedDirectory {
  DesignRecord design;
  std::optional<SceneResult> scene;
};

/// Reads what `tofsmith design -o` or `tofsmith demo -o` left in a directory.
/// @throws IoError naming the directory if it holds no finished design, or the damaged file
DesignedDirectory read_designed_directory(const std::filesystem::path& directory);

}  // namespace tofsmith
