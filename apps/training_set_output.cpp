// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "training_set_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "fresh_directory.hpp"
#include "number_pair.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/output_directory.hpp"

namespace tofsmith::apps {

bool are_many_scenes(const std::vector<std::string>& scenes) {
  std::error_code ignored;
  return scenes.size() > 1 || std::filesystem::is_directory(scenes.front(), ignored) ||
         std::filesystem::path(scenes.front()).extension() == ".txt";
}

LightRange light_range(const std::string& what, const std::string& range,
                       std::optional<double> level, double usual) {
  const std::string option = fmt::format("--{}-range", what);
  if (range.empty()) return {level.value_or(usual), level.value_or(usual)};
  if (level) throw UsageError(fmt::format("{}: expected no --{} beside it", option, what));
  LightRange parsed;
  if (!read_number_pair(range, ':', parsed.low_e_per_s, parsed.high_e_per_s) ||
      parsed.broken_rule(what))
    throw UsageError(
        fmt::format("{}: found {}; expected a:b in e/s with 0 < a <= b, such as "
                    "1e3:1e5",
                    option, range));
  return parsed;
}

void make_training_set(const TrainingSetRequest& request, const CodeSet& code, const Camera& camera,
                       Session& session) {
  const std::vector<TrainingScene> scenes = training_scenes(request.scenes);
  const auto load = [&](const TrainingScene& scene) {
    SceneSource source = request.source;
    source.scene = scene.file.string();
    LoadedScene loaded = load_scene(source, camera);
    return LoadedTrainingScene{std::move(loaded.image), loaded.view};
  };
  const FreshDirectory fresh(request.directory);
  make_output_directory(request.directory);
  session.directory = request.directory;
  const TrainingSetRun run = write_training_set(request.directory, scenes, code, camera, load,
                                                request.options, terminal_progress("simulating"));
  session.print_json({{"directory", request.directory.string()},
                      {"index", run.index.string()},
                      {"code", code.name()},
                      {"camera", camera.name},
                      {"scenes", run.scenes},
                      {"written", run.written},
                      {"kept", run.kept},
                      {"failures", run.failures}});
  session.say(fmt::format("wrote {}: {} scenes, {} of them now, {} kept", run.index.string(),
                          run.written + run.kept, run.written, run.kept));
  if (!run.failures.empty())
    throw std::runtime_error(
        fmt::format("{} of {} scenes failed, the others are there; the first: "
                    "{}",
                    run.failures.size(), run.scenes, run.failures.front()));
}

}  // namespace tofsmith::apps
