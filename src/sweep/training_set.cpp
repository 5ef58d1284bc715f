// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "tofsmith/sweep/training_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/shared/hash.hpp"
#include "core/shared/random.hpp"
#include "core/shared/text_numbers.hpp"
#include "io/arrays/shared/array_matrix.hpp"
#include "io/documents/shared/lens_document.hpp"
#include "io/shared/read_file.hpp"
#include "io/text/shared/text_lines.hpp"
#include "sweep/item_key.hpp"
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

namespace {

using Json = nlohmann::ordered_json;

/// Increased whenever the files for the same inputs change.
constexpr int training_set_version = 1;
/// Limits memory and the delay of an interrupt.
constexpr std::int64_t scenes_at_once = 16;

std::string_view bytes_of(const Image<float>& plane) {
  return {reinterpret_cast<const char*>(plane.pixels.data()), plane.size() * sizeof(float)};
}

/// Hash that seeds everything random of a scene.
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

double drawn(const std::optional<LightRange>& range, double level, double uniform) {
  if (!range) return level;
  const auto [low, high] = *range;
  return low == high ? low : std::clamp(low * std::pow(high / low, uniform), low, high);
}

struct Example {
  std::string key;
  CaptureOptions capture;
  LoadedTrainingScene scene;
};

/// Measured and true arrays.
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
  arrays["true_depth_m"] = array_of(example.scene.image.depth_m);
  arrays["albedo"] = array_of(example.scene.image.albedo);
  return arrays;
}

struct UnusableScene : std::runtime_error {
  using std::runtime_error::runtime_error;
};

LoadedTrainingScene loaded(const TrainingScene& scene, const TrainingSceneLoader& load) {
  try {
    return load(scene);
  } catch (const std::runtime_error& error) {
    throw UnusableScene(error.what());
  } catch (const std::invalid_argument& error) {
    throw UnusableScene(error.what());
  }
}

std::string index_name(const SweepShard& shard) {
  return shard.count == 1 ? "index.json"
                          : fmt::format("index-{}-of-{}.json", shard.index, shard.count);
}

}  // namespace

struct TrainingSetWriter::State {
  fs::path directory;
  CodeSet code;
  Camera camera;
  TrainingSetOptions options;
  std::string setup;
  Decoder decoder;

  Example prepared(const TrainingScene& scene, const TrainingSceneLoader& load) const;
  /// Contents of the scene's JSON file and its entry in the index.
  Json parameters_of(const TrainingScene& scene, const Example& example,
                     const std::string& stem) const;
};

Example TrainingSetWriter::State::prepared(const TrainingScene& scene,
                                           const TrainingSceneLoader& load) const {
  Example example{"", options.capture, loaded(scene, load)};
  const std::string identity = identity_of(scene, example.scene, options.capture);
  CaptureOptions& capture = example.capture;
  capture.seed = key_number(identity);
  RandomStream stream(capture.seed, key_number(std::string_view(identity).substr(16)));
  capture.signal_e_per_s = drawn(options.signal_range, capture.signal_e_per_s, stream.uniform());
  capture.ambient_e_per_s = drawn(options.ambient_range, capture.ambient_e_per_s, stream.uniform());
  example.key = fnv1a_128_hex(fmt::format(
      "{}\n{}\n{} {} {} {} {}", identity, setup, capture.signal_e_per_s, capture.ambient_e_per_s,
      capture.reference_distance_m, capture.falloff, capture.frames));
  return example;
}

Json TrainingSetWriter::State::parameters_of(const TrainingScene& scene, const Example& example,
                                             const std::string& stem) const {
  const CaptureOptions& capture = example.capture;
  return {{"name", scene.name},
          {"key", example.key},
          {"file", stem + ".npz"},
          {"frames", capture.frames},
          {"height", example.scene.image.height()},
          {"width", example.scene.image.width()},
          {"measurements", code.measurements()},
          {"code", code.name()},
          {"camera", camera.name},
          {"signal_e_per_s", capture.signal_e_per_s},
          {"ambient_e_per_s", capture.ambient_e_per_s},
          {"reference_distance_m", capture.reference_distance_m},
          {"falloff", capture.falloff},
          {"seed", capture.seed},
          {"beyond_range_share", scene_extent(example.scene.image, camera).beyond_range_share()},
          {"lens", lens_document(lens_of(example.scene.view))}};
}

TrainingSetWriter::TrainingSetWriter(fs::path directory, CodeSet code, Camera camera,
                                     TrainingSetOptions options) {
  options.validate();
  std::string setup = setup_key(camera, code);
  Decoder decoder(make_decoding_table(ForwardModel(code, camera), camera));
  state_ = make_hidden<State>(State{std::move(directory), std::move(code), std::move(camera),
                                    options, std::move(setup), std::move(decoder)});
}

std::vector<TrainingScene> TrainingSetWriter::scenes_of_shard(
    std::span<const TrainingScene> scenes) const {
  std::vector<TrainingScene> ours;
  for (const TrainingScene& scene : scenes)
    if (state_->options.shard.holds(fnv1a_128_hex(scene.name))) ours.push_back(scene);
  return ours;
}

TrainingSceneOutcome TrainingSetWriter::write(const TrainingScene& scene,
                                              const TrainingSceneLoader& load) const {
  Example example;
  try {
    example = state_->prepared(scene, load);
  } catch (const UnusableScene& error) {
    return {"", error.what()};
  }
  const std::string stem = fmt::format("{}/{}", example.key.substr(0, 2), example.key);
  const fs::path arrays = state_->directory / (stem + ".npz"),
                 parameters = state_->directory / (stem + ".json");
  const Json entry = state_->parameters_of(scene, example, stem);
  TrainingSceneOutcome outcome{entry.dump(-1, ' ', false, Json::error_handler_t::replace), ""};
  if (fs::exists(parameters) && fs::exists(arrays)) return outcome;
  make_output_directory(arrays.parent_path());
  const RawFrames raw = capture(example.scene.image, state_->code, state_->camera, example.capture);
  write_npz(arrays, arrays_of(example, raw, state_->decoder), OutputPolicy::overwrite);
  // Last, because this file marks the scene as finished.
  write_file_atomically(parameters,
                        entry.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                        OutputPolicy::overwrite);
  outcome.is_new = true;
  return outcome;
}

TrainingSetRun TrainingSetWriter::write_index(
    std::span<const TrainingScene> scenes, std::span<const TrainingSceneOutcome> outcomes) const {
  Json index = {
      {"tofsmith", TOFSMITH_VERSION}, {"training_set", training_set_version},
      {"setup", state_->setup},       {"camera", Json::parse(camera_to_json(state_->camera))},
      {"code", state_->code.name()},  {"seed", state_->options.capture.seed},
      {"scenes", Json::array()},      {"failures", Json::array()}};
  TrainingSetRun run{.scenes = static_cast<std::int64_t>(scenes.size())};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const TrainingSceneOutcome& outcome = outcomes[i];
    if (outcome.problem.empty()) {
      index["scenes"].push_back(Json::parse(outcome.entry));
      ++(outcome.is_new ? run.written : run.kept);
    } else {
      index["failures"].push_back({{"name", scenes[i].name}, {"problem", outcome.problem}});
      run.failures.push_back(outcome.problem.starts_with(scenes[i].name + ":")
                                 ? outcome.problem
                                 : fmt::format("{}: {}", scenes[i].name, outcome.problem));
    }
  }
  run.index = state_->directory / index_name(state_->options.shard);
  write_file_atomically(run.index, index.dump(1, ' ', false, Json::error_handler_t::replace) + "\n",
                        OutputPolicy::overwrite);
  return run;
}

void TrainingSetOptions::validate() const {
  check_fields(*this);
  capture.validate();
}

TrainingSetRun write_training_set(const fs::path& directory, std::span<const TrainingScene> scenes,
                                  const CodeSet& code, const Camera& camera,
                                  const TrainingSceneLoader& load,
                                  const TrainingSetOptions& options, const Progress& progress) {
  const TrainingSetWriter writer(directory, code, camera, options);
  const std::vector<TrainingScene> ours = writer.scenes_of_shard(scenes);
  const auto count = static_cast<std::int64_t>(ours.size());
  std::vector<TrainingSceneOutcome> outcomes(ours.size());
  for (std::int64_t begin = 0; begin < count; begin += scenes_at_once) {
    report(progress, static_cast<double>(begin) / static_cast<double>(count),
           fmt::format("{} of {} scenes", begin, count));
    parallel_for(std::min(scenes_at_once, count - begin), [&](std::int64_t i) {
      const auto scene = static_cast<std::size_t>(begin + i);
      outcomes[scene] = writer.write(ours[scene], load);
    });
  }
  TrainingSetRun run = writer.write_index(ours, outcomes);
  report(progress, 1.0, "scenes written");
  return run;
}

}  // namespace tofsmith
