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

/// One scene of a training set.
struct TrainingScene {
  std::string name;            ///< what it is known by: its path within the folder or the list
  std::filesystem::path file;  ///< where it is now
};

/// The scenes that folders, lists (.txt: a file a line, named from where the list stands; # starts
/// a remark) and files name, each once, in the order of their names. Of a folder, all files below
/// it that can be scenes.
/// @throws IoError for what cannot be read, an empty folder or list, and names that come twice
std::vector<TrainingScene> training_scenes(std::span<const std::string> inputs);

/// A light level: drawn log-uniformly for every scene, or the same for all.
struct LightRange {
  double low_e_per_s = 0.0, high_e_per_s = 0.0;

  /// The rule that it breaks; none if both are finite, 0 <= low <= high, and low > 0 if they
  /// differ.
  /// @param which  how errors call it
  std::optional<BrokenRule> broken_rule(const std::string& which) const;
  /// @throws InvalidArgument of broken_rule(), if there is one
  void validate(const std::string& which) const;
};

struct TrainingSetOptions {
  LightRange signal, ambient;
  CaptureOptions capture;  ///< its signal and ambient light are not used; seed of the whole set
  SweepShard shard;        ///< by the scenes' names

  /// @throws std::invalid_argument naming field, value and rule
  void validate() const;
};

/// What became of a training set.
struct TrainingSetRun {
  std::int64_t scenes = 0;             ///< of this shard
  std::int64_t written = 0, kept = 0;  ///< now, and found finished
  std::vector<std::string> failures;   ///< "name: problem" of scenes that could not be simulated
  std::filesystem::path index;         ///< the list of all that is finished
};

/// How a scene is loaded.
struct LoadedTrainingScene {
  SceneImage image;
  PinholeView view;
};
using TrainingSceneLoader = std::function<LoadedTrainingScene(const TrainingScene&)>;

/// Result of one scene.
struct TrainingSceneOutcome {
  std::string entry;    ///< of the index: JSON; "" for a scene that could not be simulated
  std::string problem;  ///< why it could not be simulated
  bool is_new = false;  ///< whether its files were written now, and not found finished
};

/// Writes the scenes of a training set in any order, and the index at the end. Several processes
/// may write into one directory. write_training_set() does all of it in one process.
class TrainingSetWriter {
 public:
  /// @throws std::invalid_argument as TrainingSetOptions::validate()
  TrainingSetWriter(std::filesystem::path directory, CodeSet code, Camera camera,
                    TrainingSetOptions options);
  ~TrainingSetWriter();
  TrainingSetWriter(const TrainingSetWriter&) = delete;
  TrainingSetWriter& operator=(const TrainingSetWriter&) = delete;

  /// The scenes that belong to the shard of the options, in their order.
  std::vector<TrainingScene> scenes_of_shard(std::span<const TrainingScene> scenes) const;
  /// Writes the files of a scene unless they are finished. Thread-safe.
  /// @param load  an error that it throws becomes the problem of the outcome
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

/// Captures and decodes every scene, and writes into `directory`, for each, KEY.npz (raw, depth_m,
/// true_depth_m, albedo) and then KEY.json (parameters), below a folder of the first two digits of
/// its key; at the end, an index. The key is a hash of everything that determines the content: what
/// is there under it is finished and stays.
/// @param load  called from several threads at a time; what it throws fails that scene only
/// @return with what failed. Noise and drawn light levels depend on the seed and the scene's name
///         and content: same bits whatever the order, the shards and the number of threads
/// @throws IoError if an output cannot be written; Interrupted if progress says so (asked between
///         scenes), then what is finished is kept
TrainingSetRun write_training_set(const std::filesystem::path& directory,
                                  std::span<const TrainingScene> scenes, const CodeSet& code,
                                  const Camera& camera, const TrainingSceneLoader& load,
                                  const TrainingSetOptions& options, const Progress& progress = {});

}  // namespace tofsmith
