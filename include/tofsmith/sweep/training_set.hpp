// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/core/hidden.hpp"
#include "tofsmith/core/progress.hpp"
#include "tofsmith/scene/scene_image.hpp"
#include "tofsmith/simulate/capture.hpp"
#include "tofsmith/sweep/run_sweep.hpp"

namespace tofsmith {

struct TrainingScene {
  std::string name;  ///< within the folder or the list
  std::filesystem::path file;
};

/// Returns the scenes of folders (all scene files below), lists and files, each once, sorted by
/// name. A list (.txt) contains one file per line, relative to the list; # starts a comment.
/// @throws IoError for unreadable inputs, empty folders or lists, and repeated names
std::vector<TrainingScene> training_scenes(std::span<const std::string> inputs);

/// Light level, drawn log-uniformly for every scene if low < high.
struct LightRange {
  double low_e_per_s = 0.0, high_e_per_s = 0.0;

  static constexpr char separator = ':';
  static constexpr std::string_view rule = "low and high in e/s with 0 < low <= high, or both 0";
  static constexpr std::string_view example = "1e3:1e5";
  bool is_valid() const {
    return low_e_per_s > 0.0 ? low_e_per_s <= high_e_per_s && std::isfinite(high_e_per_s)
                             : low_e_per_s == 0.0 && high_e_per_s == 0.0;
  }
};
auto fields_of(ConstOrNot<LightRange> auto& r) {
  return std::tuple(Field("low_e_per_s", r.low_e_per_s), Field("high_e_per_s", r.high_e_per_s));
}

struct TrainingSetOptions {
  std::optional<LightRange> signal_range, ambient_range;  ///< override the light of `capture`
  SweepShard shard;
  CaptureOptions capture;  ///< seed of the whole set

  /// @throws std::invalid_argument
  void validate() const;
};
auto fields_of(ConstOrNot<TrainingSetOptions> auto& o) {
  return std::tuple(
      Field("signal_range", o.signal_range,
            Help{"range [e/s] from which the signal of each of several scenes is drawn "
                 "log-uniformly"},
            IfAbsent{"the signal of the capture for all scenes"}),
      Field("ambient_range", o.ambient_range,
            Help{"range [e/s] from which the ambient light of each of several scenes is drawn "
                 "log-uniformly"},
            IfAbsent{"the ambient light of the capture for all scenes"}),
      Field("shard", o.shard,
            Help{"index and count of parts: simulate only one part of the scenes, selected by the "
                 "names of the scenes; all parts can have the same output directory"}),
      Field("capture", o.capture, FieldMark::apart));
}

struct TrainingSetRun {
  std::int64_t scenes = 0;
  std::int64_t written = 0, kept = 0;
  std::vector<std::string> failures;
  std::filesystem::path index;
};
auto fields_of(ConstOrNot<TrainingSetRun> auto& r) {
  return std::tuple(
      Field("scenes", r.scenes, Help{"scenes in this shard"}),
      Field("written", r.written, Help{"scenes written by this run"}),
      Field("kept", r.kept, Help{"scenes finished before"}),
      Field("failures", r.failures, Help{"\"name: problem\" of scenes that are not usable"}),
      Field("index", r.index, Help{"index of all finished scenes"}));
}

struct LoadedTrainingScene {
  SceneImage image;
  PinholeView view;
};
using TrainingSceneLoader = std::function<LoadedTrainingScene(const TrainingScene&)>;

struct TrainingSceneOutcome {
  std::string entry;  ///< JSON; "" if failed
  std::string problem;
  bool is_new = false;  ///< written by this call
};

/// Writes the scenes of a training set in any order, and the index at the end; see
/// write_training_set(). Several processes may write to one directory.
class TrainingSetWriter {
 public:
  TrainingSetWriter(std::filesystem::path directory, CodeSet code, Camera camera,
                    TrainingSetOptions options);

  /// Returns the scenes of the shard.
  std::vector<TrainingScene> scenes_of_shard(std::span<const TrainingScene> scenes) const;
  /// Writes a scene unless it is finished. Thread-safe.
  /// @param load  its exceptions become `problem` of the outcome
  /// @throws IoError if an output cannot be written
  TrainingSceneOutcome write(const TrainingScene& scene, const TrainingSceneLoader& load) const;
  /// Writes the index. @throws IoError if it cannot be written
  TrainingSetRun write_index(std::span<const TrainingScene> scenes,
                             std::span<const TrainingSceneOutcome> outcomes) const;

 private:
  struct State;
  Hidden<State> state_;
};

/// Captures and decodes every scene: KEY.npz (raw, depth_m, true_depth_m, albedo) and KEY.json
/// (parameters) in a folder named after the first two digits of the key, and finally the index. The
/// key is a hash of everything that determines the content; existing scenes are kept. Results have
/// the same bits for any order, sharding and number of threads.
/// @param load  called from several threads; an exception fails only its scene
/// @throws IoError if an output cannot be written; Interrupted between scenes; finished scenes are
///         kept
TrainingSetRun write_training_set(const std::filesystem::path& directory,
                                  std::span<const TrainingScene> scenes, const CodeSet& code,
                                  const Camera& camera, const TrainingSceneLoader& load,
                                  const TrainingSetOptions& options, const Progress& progress = {});

}  // namespace tofsmith
