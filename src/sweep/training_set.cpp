// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/training_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/shared/hash.hpp"
#include "core/shared/random.hpp"
#include "io/documents/shared/lens_document.hpp"
#include "sweep/item_key.hpp"
#include "sweep/key_order.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/core/parallel.hpp"
#include "tofsmith/decode/decoder.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/simulate/scene_result.hpp"
#include "tofsmith/version.hpp"

namespace tofsmith {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Changes whenever the same inputs give other files.
constexpr int training_set_version = 1;
/// Scenes in work at a time: an interrupt waits for them, and memory holds them.
constexpr std::int64_t scenes_at_once = 16;

std::string_view bytes_of(const Image<float>& plane) {
  return {reinterpret_cast<const char*>(plane.pixels.data()), plane.size() * sizeof(float)};
}

/// What a scene is, by which all that is random is drawn: the set's seed, its name and content.
std::string identity_of(const TrainingScene& scene, const LoadedTrainingScene& loaded,
                        const CaptureOptions& capture) {
  const SceneImage& image = loaded.image;
  std::string text = fmt::format("training set {}\nseed {}\nname {}\n{} {}\n", training_set_version,
                                 capture.seed, scene.name, image.height(), image.width());
  for (const Image<float>* plane :
       {&image.depth_m, &image.albedo, &image.cosine, &image.ambient_scale})
    text += fnv1a_128_hex(bytes_of(*plane)) + "\n";
  return fnv1a_128_hex(text);
}

double drawn(const LightRange& range, double uniform) {
  if (range.low_e_per_s == range.high_e_per_s) return range.low_e_per_s;
  const double level =
      range.low_e_per_s * std::pow(range.high_e_per_s / range.low_e_per_s, uniform);
  return std::clamp(level, range.low_e_per_s, range.high_e_per_s);
}

/// A scene with all that determines its files.
struct Example {
  std::string key;
  CaptureOptions capture;
  LoadedTrainingScene scene;
};

NpyArray plane_array(const Image<float>& plane) {
  return NpyArray::of<float>(
      {static_cast<std::size_t>(plane.height), static_cast<std::size_t>(plane.width)},
      plane.pixels);
}

/// What is measured and what is true of one scene.
NpzArrays arrays_of(const Example& example, const RawFrames& raw, const Decoder& decoder) {
  const auto frames = static_cast<std::size_t>(raw.frames);
  const auto height = static_cast<std::size_t>(raw.height);
  const auto width = static_cast<std::size_t>(raw.width);
  std::vector<float> depth_m;
  for (int f = 0; f < raw.frames; ++f) {
    const DepthImage decoded = decoder.decode(raw, f);
    depth_m.insert(depth_m.end(), decoded.depth_m.pixels.begin(), decoded.depth_m.pixels.end());
  }
  NpzArrays arrays;
  arrays["raw"] = NpyArray::of<float>(
      {frames, height, width, static_cast<std::size_t>(raw.measurements)}, raw.values);
  arrays["depth_m"] = NpyArray::of<float>({frames, height, width}, depth_m);
  arrays["true_depth_m"] = plane_array(example.scene.image.depth_m);
  arrays["albedo"] = plane_array(example.scene.image.albedo);
  return arrays;
}

/// What came of one scene: its entry in the index, or a problem.
struct SceneOutcome {
  Json entry;
  std::string problem;
};

class TrainingSet {
 public:
  TrainingSet(fs::path directory, const CodeSet& code, const Camera& camera,
              const TrainingSceneLoader& load, const TrainingSetOptions& options)
      : directory_(std::move(directory)),
        code_(code),
        camera_(camera),
        load_(load),
        options_(options),
        setup_(setup_key(camera, code)),
        decoder_(make_decoding_table(ForwardModel(code, camera), camera)) {}

  /// @throws IoError if its files cannot be written
  SceneOutcome write(const TrainingScene& scene) {
    try {
      return {write(scene, prepared(scene)), ""};
    } catch (const UnusableScene& error) {
      return {Json(), error.what()};
    }
  }

  std::int64_t written() const { return written_; }
  std::int64_t kept() const { return kept_; }
  const std::string& setup() const { return setup_; }

 private:
  struct UnusableScene : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  LoadedTrainingScene loaded(const TrainingScene& scene) const {
    try {
      return load_(scene);
    } catch (const std::runtime_error& error) {
      throw UnusableScene(error.what());
    } catch (const std::invalid_argument& error) {
      throw UnusableScene(error.what());
    }
  }

  /// The scene's entry in the index.
  Json write(const TrainingScene& scene, const Example& example) {
    const std::string stem = fmt::format("{}/{}", example.key.substr(0, 2), example.key);
    const fs::path arrays = directory_ / (stem + ".npz"),
                   parameters = directory_ / (stem + ".json");
    Json entry = parameters_of(scene, example, stem);
    if (fs::exists(parameters) && fs::exists(arrays)) {
      ++kept_;
      return entry;
    }
    make_output_directory(arrays.parent_path());
    const RawFrames raw = capture(example.scene.image, code_, camera_, example.capture);
    write_npz(arrays, arrays_of(example, raw, decoder_), OutputPolicy::overwrite);
    // Last: it says that all is there.
    write_file_atomically(parameters,
                          entry.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                          OutputPolicy::overwrite);
    ++written_;
    return entry;
  }

  Example prepared(const TrainingScene& scene) const {
    Example example{"", options_.capture, loaded(scene)};
    const std::string identity = identity_of(scene, example.scene, options_.capture);
    CaptureOptions& capture = example.capture;
    capture.seed = key_number(identity);
    RandomStream stream(capture.seed, key_number(std::string_view(identity).substr(16)));
    capture.signal_e_per_s = drawn(options_.signal, stream.uniform());
    capture.ambient_e_per_s = drawn(options_.ambient, stream.uniform());
    example.key = fnv1a_128_hex(fmt::format(
        "{}\n{}\n{} {} {} {} {}", identity, setup_, capture.signal_e_per_s, capture.ambient_e_per_s,
        capture.reference_distance_m, capture.falloff, capture.frames));
    return example;
  }

  Json parameters_of(const TrainingScene& scene, const Example& example,
                     const std::string& stem) const {
    const CaptureOptions& capture = example.capture;
    return {{"name", scene.name},
            {"key", example.key},
            {"file", stem + ".npz"},
            {"frames", capture.frames},
            {"height", example.scene.image.height()},
            {"width", example.scene.image.width()},
            {"measurements", code_.measurements()},
            {"code", code_.name()},
            {"camera", camera_.name},
            {"signal_e_per_s", capture.signal_e_per_s},
            {"ambient_e_per_s", capture.ambient_e_per_s},
            {"reference_distance_m", capture.reference_distance_m},
            {"falloff", capture.falloff},
            {"seed", capture.seed},
            {"beyond_range_share", scene_extent(example.scene.image, camera_).beyond_range_share()},
            {"lens", lens_document(lens_of(example.scene.view))}};
  }

  fs::path directory_;
  const CodeSet& code_;
  const Camera& camera_;
  const TrainingSceneLoader& load_;
  const TrainingSetOptions& options_;
  std::string setup_;
  Decoder decoder_;
  std::atomic<std::int64_t> written_ = 0, kept_ = 0;
};

std::string index_name(const SweepShard& shard) {
  return shard.count == 1 ? "index.json"
                          : fmt::format("index-{}-of-{}.json", shard.index, shard.count);
}

}  // namespace

std::optional<BrokenRule> LightRange::broken_rule(const std::string& which) const {
  if (!(std::isfinite(low_e_per_s) && low_e_per_s >= 0.0))
    return broken(which + ".low_e_per_s", low_e_per_s, "must be finite and >= 0");
  if (!(std::isfinite(high_e_per_s) && high_e_per_s >= low_e_per_s))
    return broken(which + ".high_e_per_s", high_e_per_s, "must be finite and >= low_e_per_s");
  if (!(low_e_per_s > 0.0) && high_e_per_s != low_e_per_s)
    return broken(which + ".low_e_per_s", low_e_per_s, "must be > 0 where levels are drawn");
  return std::nullopt;
}

void LightRange::validate(const std::string& which) const { require(broken_rule(which)); }

void TrainingSetOptions::validate() const {
  signal.validate("signal");
  ambient.validate("ambient");
  capture.validate();
  shard.validate();
}

TrainingSetRun write_training_set(const fs::path& directory, std::span<const TrainingScene> scenes,
                                  const CodeSet& code, const Camera& camera,
                                  const TrainingSceneLoader& load,
                                  const TrainingSetOptions& options, const Progress& progress) {
  options.validate();
  std::vector<TrainingScene> ours;
  for (const TrainingScene& scene : scenes)
    if (options.shard.holds(fnv1a_128_hex(scene.name))) ours.push_back(scene);
  TrainingSet set(directory, code, camera, load, options);
  TrainingSetRun run{.scenes = static_cast<std::int64_t>(ours.size())};
  Json index = {{"tofsmith", TOFSMITH_VERSION}, {"training_set", training_set_version},
                {"setup", set.setup()},         {"camera", Json::parse(camera_to_json(camera))},
                {"code", code.name()},          {"seed", options.capture.seed},
                {"scenes", Json::array()},      {"failures", Json::array()}};
  for (std::int64_t begin = 0; begin < run.scenes; begin += scenes_at_once) {
    report(progress, static_cast<double>(begin) / static_cast<double>(run.scenes),
           fmt::format("{} of {} scenes", begin, run.scenes));
    std::vector<SceneOutcome> outcomes(
        static_cast<std::size_t>(std::min(scenes_at_once, run.scenes - begin)));
    parallel_for(static_cast<std::int64_t>(outcomes.size()), [&](std::int64_t i) {
      outcomes[static_cast<std::size_t>(i)] = set.write(ours[static_cast<std::size_t>(begin + i)]);
    });
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i].problem.empty()) {
        index["scenes"].push_back(std::move(outcomes[i].entry));
        continue;
      }
      const std::string& name = ours[static_cast<std::size_t>(begin) + i].name;
      index["failures"].push_back({{"name", name}, {"problem", outcomes[i].problem}});
      run.failures.push_back(fmt::format("{}: {}", name, outcomes[i].problem));
    }
  }
  run.written = set.written();
  run.kept = set.kept();
  run.index = directory / index_name(options.shard);
  write_file_atomically(run.index, index.dump(1, ' ', false, Json::error_handler_t::replace) + "\n",
                        OutputPolicy::overwrite);
  report(progress, 1.0, "scenes written");
  return run;
}

}  // namespace tofsmith
