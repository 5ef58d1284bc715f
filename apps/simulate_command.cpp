// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "described_options.hpp"
#include "fresh_directory.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "recorded_with.hpp"
#include "scene_source.hpp"
#include "session.hpp"
#include "simulate_light.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/atomic_file.hpp"
#include "tofsmith/io/camera_toml.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/image_file.hpp"
#include "tofsmith/io/mesh_file.hpp"
#include "tofsmith/io/npy.hpp"
#include "tofsmith/io/raw_frames.hpp"
#include "tofsmith/simulate/staged_capture.hpp"
#include "tofsmith/sweep/training_set.hpp"

namespace tofsmith::apps {
namespace {

/// Returns true if the arguments name more than one scene.
bool are_many_scenes(const std::vector<std::string>& scenes) {
  std::error_code ignored;
  return scenes.size() > 1 || std::filesystem::is_directory(scenes.front(), ignored) ||
         std::filesystem::path(scenes.front()).extension() == ".txt";
}

struct SimulateArguments {
  std::vector<std::string> scenes;
  SceneSource scene;
  CameraArguments camera;
  TapArguments taps;
  std::string code;
  std::optional<double> signal_e_per_s, ambient_e_per_s;
  CaptureOptions options;
  TrainingSetOptions set;  ///< without `capture`
  MultipathLightArguments returns;
  std::string stray_light;
  std::string output, truth, truth_near, truth_far;
};

void set_light(SimulateArguments& arguments, const Camera& camera) {
  const OperatingPoint usual = capture_light(camera, arguments.options.reference_distance_m);
  arguments.options.signal_e_per_s = arguments.signal_e_per_s.value_or(usual.signal_e_per_s);
  arguments.options.ambient_e_per_s = arguments.ambient_e_per_s.value_or(usual.ambient_e_per_s);
}

/// Simulates the scenes and prints a summary.
/// @throws as write_training_set(); std::runtime_error if some scenes failed
void make_training_set(const SimulateArguments& arguments, const CodeSet& code,
                       const Camera& camera, Session& session) {
  const std::filesystem::path directory = arguments.output;
  const std::vector<TrainingScene> scenes = training_scenes(arguments.scenes);
  const auto load = [&](const TrainingScene& scene) {
    SceneSource source = arguments.scene;
    source.scene = scene.file.string();
    LoadedScene loaded = scene_of(source, camera);
    return LoadedTrainingScene{std::move(loaded.image), loaded.view};
  };
  const FreshDirectory fresh(directory);
  make_output_directory(directory);
  session.directory = directory;
  const TrainingSetRun run = write_training_set(directory, scenes, code, camera, load,
                                                arguments.set, terminal_progress("simulating"));
  session.print_json({{"directory", directory.string()},
                      {"index", run.index.string()},
                      {"code", code.name()},
                      {"camera", camera.name},
                      {"scenes", run.scenes},
                      {"written", run.written},
                      {"kept", run.kept},
                      {"failures", run.failures}});
  session.say(fmt::format("wrote {}: {} scenes, {} new, {} kept", run.index.string(),
                          run.written + run.kept, run.written, run.kept));
  if (!run.failures.empty())
    throw std::runtime_error(
        fmt::format("{} of {} scenes failed, and the others were written; first failure: {}",
                    run.failures.size(), run.scenes, run.failures.front()));
}

/// Simulated capture of one scene.
struct CapturedScene {
  StagedCapture capture;
  SceneLight light;  ///< multipath light
  bool is_still = true;
};

/// Captures a scene: a depth image pixel by pixel, shapes through the camera's lens.
CapturedScene capture_one(const SimulateArguments& arguments, const LoadedScene& scene,
                          const CodeSet& code, const Camera& camera) {
  CapturedScene captured;
  const Progress progress = terminal_progress("capturing");
  const Image<float> kernel =
      arguments.stray_light.empty() ? Image<float>() : read_stray_light(arguments.stray_light);
  if (!scene.staged) {
    captured.light = arguments.returns.load(scene, camera);
    captured.light.stray_light = kernel;
    captured.capture.raw =
        capture(scene.image, captured.light, code, camera, arguments.options, progress);
    captured.capture.truth = {scene.image};
    return captured;
  }
  StagedSetup setup{.search_of = embree_search(),
                    .light = {},
                    .ambient_scale = scene.image.ambient_scale,
                    .stray_light = kernel};
  if (arguments.returns.is_used())
    setup.light = [&](const StagedScene& staged, const SceneImage& rays) {
      captured.light = arguments.returns.load({scene.name, rays, staged.view, staged}, camera);
      return captured.light;
    };
  captured.is_still = scene.staged->is_still();
  captured.capture = capture(*scene.staged, code, camera, arguments.options, setup, progress);
  return captured;
}

/// Writes the requested ground truth.
void write_truth(const SimulateArguments& arguments, const CapturedScene& captured,
                 OutputPolicy policy) {
  const StagedCapture& made = captured.capture;
  const auto write = [&](const std::string& path, const auto& frames, const auto& depth_of) {
    if (path.empty()) return;
    if (frames.size() == 1 && captured.is_still)
      return write_depth(path, std::invoke(depth_of, frames.front()), policy);
    const Image<float>& first = std::invoke(depth_of, frames.front());
    std::vector<float> all;
    for (const auto& frame : frames) {
      const Image<float>& depth_m = std::invoke(depth_of, frame);
      all.insert(all.end(), depth_m.pixels.begin(), depth_m.pixels.end());
    }
    write_npy(path,
              NpyArray::of<float>({frames.size(), static_cast<std::size_t>(first.height),
                                   static_cast<std::size_t>(first.width)},
                                  all),
              policy);
  };
  write(arguments.truth, made.truth, &SceneImage::depth_m);
  write(arguments.truth_near, made.near_m, std::identity());
  write(arguments.truth_far, made.far_m, std::identity());
  if (!arguments.returns.truth().empty())
    write_multipath_truth(arguments.returns.truth(),
                          multipath_truth(made.truth.front(), captured.light, arguments.options),
                          captured.light, policy);
}

/// Checks that the scene and the lens support the requested ground truth.
/// @throws UsageError
void check_truth(const SimulateArguments& arguments, const LoadedScene& scene,
                 const Camera& camera) {
  if (!scene.staged && !(arguments.truth_near.empty() && arguments.truth_far.empty()))
    throw UsageError(
        fmt::format("--truth-near, --truth-far: found {}, a depth image; expected a built-in "
                    "scene, a scene file (.toml) or a mesh",
                    scene.name));
  if (scene.staged && !scene.staged->is_still()) {
    for (const auto& [option, file] :
         {std::pair("--truth", arguments.truth), std::pair("--truth-near", arguments.truth_near),
          std::pair("--truth-far", arguments.truth_far)})
      if (!file.empty() && std::filesystem::path(file).extension() != ".npy")
        throw UsageError(
            fmt::format("{} {}: the scene {} moves; expected a .npy file, for the depth of every "
                        "frame (F, H, W)",
                        option, file, scene.name));
    if (!arguments.returns.truth().empty())
      throw UsageError(fmt::format("--truth-multipath: the scene {} moves; expected a static scene",
                                   scene.name));
  }
  if (!arguments.returns.truth().empty() && camera.blur && camera.blur->pixel_samples > 1)
    throw UsageError(
        fmt::format("--truth-multipath: found lens.pixel_samples = {}; expected 1, because the "
                    "file contains the returns of one ray per pixel",
                    camera.blur->pixel_samples));
}

void simulate_set(SimulateArguments& arguments, Session& session) {
  if (const std::filesystem::path output = arguments.output;
      output.extension() == ".npy" || output.extension() == ".npz")
    throw UsageError(
        fmt::format("-o {}: found several scenes; expected a directory", output.string()));
  if (!(arguments.truth.empty() && arguments.truth_near.empty() && arguments.truth_far.empty()))
    throw UsageError(
        "--truth: is not valid with several scenes, whose ground truth is always written");
  if (arguments.returns.is_used())
    throw UsageError(
        "--multipath, --tail, --multipath-file, --transient, --bounces, --truth-multipath: found "
        "several scenes; expected one");
  if (!arguments.stray_light.empty())
    throw UsageError("--stray-light: found several scenes; expected one");
  const Camera camera = arguments.camera.load();
  set_light(arguments, camera);
  arguments.set.capture = arguments.options;
  make_training_set(
      arguments,
      load_camera_code(arguments.code, camera, arguments.taps.file_for({arguments.code})), camera,
      session);
}

/// Rejects options that are only valid with several scenes.
void check_is_of_one_scene(const CLI::App& command) {
  for (const char* option : {"--signal-range", "--ambient-range", "--shard"})
    if (command.count(option) > 0)
      throw UsageError(
          fmt::format("{}: is only valid with a folder, a list (.txt) or several scenes", option));
}

/// Returns false if the camera file next to the frames is the camera argument itself.
bool leaves_camera(const SimulateArguments& arguments) {
  std::error_code ignored;
  return !std::filesystem::equivalent(camera_beside(arguments.output), arguments.camera.name,
                                      ignored);
}

/// Returns false if the code file next to the frames is the code argument itself, or has the same
/// content.
bool leaves_code(const SimulateArguments& arguments, const CodeSet& code) {
  std::error_code ignored;
  if (std::filesystem::equivalent(code_beside(arguments.output), arguments.code, ignored))
    return false;
  std::ifstream before(code_beside(arguments.output), std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(before), {}) != code_to_json(code);
}

/// Returns the first line of the camera file next to the frames. Files with this line may be
/// replaced.
std::string camera_heading(const SimulateArguments& arguments) {
  return fmt::format("# camera of {}, written by tofsmith simulate",
                     std::filesystem::path(arguments.output).filename().string());
}

/// Returns the policy for the camera and code files next to the frames.
OutputPolicy camera_policy(const SimulateArguments& arguments, const Session& session) {
  std::ifstream before(camera_beside(arguments.output));
  std::string heading;
  std::getline(before, heading);
  return heading.starts_with(camera_heading(arguments)) ? OutputPolicy::overwrite
                                                        : session.output_policy();
}

/// Writes the code and the camera for decoding, with the lens of the simulated view.
void leave_camera(const SimulateArguments& arguments, Camera camera, const CodeSet& code,
                  const PinholeView& view, const Session& session) {
  if (leaves_code(arguments, code))
    write_file_atomically(code_beside(arguments.output), code_to_json(code),
                          camera_policy(arguments, session));
  if (!leaves_camera(arguments)) return;
  if (!camera.lens || camera.lens->rays.empty()) camera.lens = lens_of(view);
  write_file_atomically(camera_beside(arguments.output),
                        fmt::format("{}, code {}\n{}", camera_heading(arguments), code.name(),
                                    camera_to_toml(camera)),
                        camera_policy(arguments, session));
}

/// Checks that no output is an input or exists already.
OutputPolicy check_outputs(const SimulateArguments& arguments, const CodeSet& recorded,
                           const Session& session) {
  const std::filesystem::path camera = camera_beside(arguments.output),
                              code = code_beside(arguments.output);
  std::vector<std::filesystem::path> outputs{arguments.output};  // in the order of writing
  if (leaves_camera(arguments)) outputs.push_back(camera);
  if (leaves_code(arguments, recorded)) outputs.push_back(code);
  for (const std::string& truth :
       {arguments.truth, arguments.truth_near, arguments.truth_far, arguments.returns.truth()})
    if (!truth.empty()) outputs.emplace_back(truth);
  for (const std::string& truth : {arguments.truth, arguments.truth_near, arguments.truth_far})
    if (!truth.empty()) depth_extension(truth);  // checks it
  const OutputPolicy policy = policy_to_go_on(outputs, session.output_policy());
  for (const std::filesystem::path& output : outputs)
    session.check_output(
        output, output == camera || output == code ? camera_policy(arguments, session) : policy);
  return policy;
}

void run(SimulateArguments& arguments, const CLI::App& command, Session& session) {
  if (are_many_scenes(arguments.scenes)) return simulate_set(arguments, session);
  check_is_of_one_scene(command);
  arguments.scene.scene = arguments.scenes.front();
  const Camera camera = arguments.camera.load();
  const CodeSet code =
      load_camera_code(arguments.code, camera, arguments.taps.file_for({arguments.code}));
  const OutputPolicy policy = check_outputs(arguments, code, session);
  const LoadedScene scene = scene_of(arguments.scene, camera);
  check_truth(arguments, scene, camera);
  set_light(arguments, camera);
  const CapturedScene captured = capture_one(arguments, scene, code, camera);
  const RawFrames& raw = captured.capture.raw;
  write_raw_frames(arguments.output, raw, policy);
  leave_camera(arguments, camera, code, scene.view, session);
  write_truth(arguments, captured, policy);
  const SceneExtent extent = scene_extent(scene.image, camera);
  session.print_json({{"scene", scene.name},
                      {"code", code.name()},
                      {"camera", camera.name},
                      {"frames", raw.frames},
                      {"height", raw.height},
                      {"width", raw.width},
                      {"measurements", raw.measurements},
                      {"signal_e_per_s", arguments.options.signal_e_per_s},
                      {"ambient_e_per_s", arguments.options.ambient_e_per_s},
                      {"seed", arguments.options.seed},
                      {"range_m", extent.range_m},
                      {"beyond_range_share", extent.beyond_range_share()},
                      {"lens", nlohmann::ordered_json::parse(lens_to_json(lens_of(scene.view)))},
                      {"output", arguments.output}});
  session.say(fmt::format(
      "wrote {}: {} frame{} of {} x {} pixels, {} measurements of {} (S = {:.4g} e/s at {:.3g} m, "
      "A = {:.4g} e/s, seed {})",
      arguments.output, raw.frames, raw.frames == 1 ? "" : "s", raw.height, raw.width,
      raw.measurements, code.name(), arguments.options.signal_e_per_s,
      arguments.options.reference_distance_m, arguments.options.ambient_e_per_s,
      arguments.options.seed));
  if (extent.beyond_range > 0) session.say(beyond_range_remark(extent));
  if (const std::string remark = albedo_remark(scene); !remark.empty()) session.say(remark);
  if (!(lens_setting(scene.view) ==
        lens_setting(view_of(camera.lens, scene.image.width(), scene.image.height()))))
    session.say(
        fmt::format("note: {} contains the lens of this view; with another --camera, points and "
                    "z-depth require --set '{}'",
                    camera_beside(arguments.output).string(), lens_setting(scene.view)));
}

}  // namespace

void add_simulate_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command =
      app.add_subcommand("simulate", "simulate raw measurements of one or several scenes");
  command
      ->add_option("SCENE", arguments->scenes,
                   std::string(scene_help) +
                       "; several scenes: a folder, a list (.txt) or several arguments")
      ->required();
  add_scene_options(*command, arguments->scene);
  command->add_option("--code", arguments->code, "family or code file")->required();
  arguments->camera.add_to(*command);
  arguments->camera.add_temperature_to(*command);
  arguments->taps.add_to(*command);
  command
      ->add_option("--signal", arguments->signal_e_per_s,
                   "signal of a white surface at the reference distance [e/s] (default: from "
                   "the camera's [optics]; without [optics], the middle of its operating points)")
      ->check(number_from_0_on())
      ->transform(number_in("e/s"));
  command
      ->add_option("--ambient", arguments->ambient_e_per_s,
                   "ambient light [e/s] (default: from the camera's [optics]; without [optics], "
                   "the middle of its operating points)")
      ->check(number_from_0_on())
      ->transform(number_in("e/s"));
  const FieldOptions set(*command, arguments->set);
  set.add("signal_range")->excludes(command->get_option("--signal"))->group(for_experts);
  set.add("ambient_range")->excludes(command->get_option("--ambient"))->group(for_experts);
  set.add("shard")->group(for_experts);
  const FieldOptions options(*command, arguments->options);
  options.add("reference_distance_m", "--reference-distance")->group(for_experts);
  options.add("falloff", "!--no-falloff")->group(for_experts);
  options.add("frames");
  options.add("seed");
  command
      ->add_option("-o,--output", arguments->output,
                   "raw frames (.npy .npz); with several scenes, a directory")
      ->required();
  command
      ->add_option("--stray-light", arguments->stray_light,
                   "kernel of the lens's stray light to simulate, from calibrate stray-light (.npy "
                   ".npz .exr .pfm); decode --stray-light removes it")
      ->group(for_experts);
  command->add_option("--truth", arguments->truth, "also write the true radial distance");
  command
      ->add_option("--truth-near", arguments->truth_near,
                   "also write the nearest distance from which each pixel receives light; not for "
                   "depth images")
      ->group(for_experts);
  command
      ->add_option(
          "--truth-far", arguments->truth_far,
          "also write the farthest distance from which each pixel receives light (docs/scenes.md)")
      ->group(for_experts);
  arguments->returns.add_to(*command);
  command->callback([arguments, command, &session] { run(*arguments, *command, session); });
}

}  // namespace tofsmith::apps
