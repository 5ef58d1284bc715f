// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

struct TrainingScene {
  std::string name;            ///< path within the folder or the list
  std::filesystem::path file;  ///< current path
};

/// Returns the scenes named by folders, lists and files, each once, sorted by name. A folder
/// contributes all scene files below it. A list (.txt) contains one file per line, relative to the
/// list; # starts a comment.
/// @throws IoError for unreadable inputs, empty folders or lists, and repeated names
std::vector<TrainingScene> training_scenes(std::span<const std::string> inputs);

/// A light level: drawn log-uniformly for every scene, or the same for all.
struct LightRange {
  double low_e_per_s = 0.0, high_e_per_s = 0.0;

  /// Returns the violated rule; none if both are finite, 0 <= low <= high, and low > 0 if they
  /// differ.
  /// @param which  name in errors
  std::optional<BrokenRule> broken_rule(const std::string& which) const;
  /// @throws InvalidArgument with broken_rule()
  void validate(const std::string& which) const;
};

struct TrainingSetOptions {
  LightRange signal, ambient;
  CaptureOptions capture;  ///< signal and ambient are ignored; seed of the whole set
  SweepShard shard;        ///< by the names of the scenes

  /// @throws std::invalid_argument
  void validate() const;
};

/// Result of writing a training set.
struct TrainingSetRun {
  std::int64_t scenes = 0;             ///< in this shard
  std::int64_t written = 0, kept = 0;  ///< written by this run; finished before
  std::vector<std::string> failures;   ///< "name: problem" of scenes that failed
  std::filesystem::path index;         ///< list of all finished scenes
};

struct LoadedTrainingScene {
  SceneImage image;
  PinholeView view;
};
using TrainingSceneLoader = std::function<LoadedTrainingScene(const TrainingScene&)>;

struct TrainingSceneOutcome {
  std::string entry;    ///< JSON entry of the index; "" if the scene failed
  std::string problem;  ///< why it failed
  bool is_new = false;  ///< files were written by this call
};

/// Writes the scenes of a training set in any order, and the index at the end. Several processes
/// may write to one directory. write_training_set() does everything in one process.
class TrainingSetWriter {
 public:
  /// @throws std::invalid_argument as TrainingSetOptions::validate()
  TrainingSetWriter(std::filesystem::path directory, CodeSet code, Camera camera,
                    TrainingSetOptions options);
  ~TrainingSetWriter();
  TrainingSetWriter(const TrainingSetWriter&) = delete;
  TrainingSetWriter& operator=(const TrainingSetWriter&) = delete;

  /// Returns the scenes of the shard, in their order.
  std::vector<TrainingScene> scenes_of_shard(std::span<const TrainingScene> scenes) const;
  /// Writes the files of a scene unless they are finished. Thread-safe.
  /// @param load  its exceptions are reported in `problem` of the outcome
  /// @throws IoError if an output cannot be written
  TrainingSceneOutcome write(const TrainingScene& scene, const TrainingSceneLoader& load) const;
  /// Writes the index of the scenes, in their order.
  /// @throws IoError if it cannot be written
  TrainingSetRun write_index(std::span<const TrainingScene> scenes,
                             std::span<const TrainingSceneOutcome> outcomes) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Captures and decodes every scene. Writes KEY.npz (raw, depth_m, true_depth_m, albedo) and then
/// KEY.json (parameters) per scene, in a folder named after the first two digits of the key;
/// finally writes the index. The key is a hash of everything that determines the content, so
/// existing scenes are not written again. Noise and random light levels depend only on the seed and
/// on the scene's name and content, so results have the same bits for any order, sharding and
/// number of threads.
/// @param load  called from several threads; an exception fails only its scene
/// @return counts and failures
/// @throws IoError if an output cannot be written; Interrupted if `progress` cancels (checked
///         between scenes); finished scenes are kept
TrainingSetRun write_training_set(const std::filesystem::path& directory,
                                  std::span<const TrainingScene> scenes, const CodeSet& code,
                                  const Camera& camera, const TrainingSceneLoader& load,
                                  const TrainingSetOptions& options, const Progress& progress = {});

}  // namespace tofsmith
