// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "number_checks.hpp"
#include "returns_arguments.hpp"
#include "scene_source.hpp"
#include "shard_argument.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/depth_file.hpp"
#include "tofsmith/io/raw_frames_file.hpp"
#include "tofsmith/io/returns_file.hpp"
#include "tofsmith/simulate/multipath_capture.hpp"
#include "training_set_output.hpp"

namespace tofsmith::apps {

namespace {

struct SimulateArguments {
  std::vector<std::string> scenes;
  SceneSource scene;
  CameraArguments camera;
  TapArguments taps;
  std::string code;
  std::optional<double> signal_e_per_s, ambient_e_per_s;
  std::string signal_range, ambient_range, shard;
  CaptureOptions options;
  ReturnsArguments returns;
  std::string output, truth;
};

void simulate_set(const SimulateArguments& arguments, Session& session) {
  if (!arguments.truth.empty())
    throw UsageError("--truth: the truth of many scenes is always written");
  if (arguments.returns.is_used())
    throw UsageError(
        "--second-return, --tail, --returns, --transient, --bounces, --truth-returns: found many "
        "scenes; "
        "expected one");
  const Camera camera = arguments.camera.load();
  const OperatingPoint middle = camera.operating.middle();
  make_training_set(
      {.scenes = arguments.scenes,
       .source = arguments.scene,
       .directory = arguments.output,
       .options = {.signal = light_range("signal", arguments.signal_range, arguments.signal_e_per_s,
                                         middle.signal_e_per_s),
                   .ambient = light_range("ambient", arguments.ambient_range,
                                          arguments.ambient_e_per_s, middle.ambient_e_per_s),
                   .capture = arguments.options,
                   .shard = parse_shard(arguments.shard)}},
      load_played_code(arguments.code, camera, arguments.taps.file_options()), camera, session);
}

/// What only many scenes have.
void check_is_of_one_scene(const SimulateArguments& arguments) {
  for (const auto& [option, value] : {std::pair("--signal-range", arguments.signal_range),
                                      std::pair("--ambient-range", arguments.ambient_range),
                                      std::pair("--shard", arguments.shard)})
    if (!value.empty())
      throw UsageError(fmt::format("{}: needs a folder, a list (.txt) or several scenes", option));
}

/// Before the work: no output is an input, or there already.
void check_outputs(const SimulateArguments& arguments, const Session& session) {
  std::vector<std::string> inputs = arguments.returns.inputs();
  inputs.insert(inputs.end(),
                {arguments.scene.scene, arguments.scene.image, arguments.scene.ambient_image,
                 arguments.code, arguments.camera.name});
  for (const std::string& output : {arguments.output, arguments.truth, arguments.returns.truth()})
    check_not_input(output, inputs);
  session.check_output(arguments.output);
  for (const std::string& truth : {arguments.truth, arguments.returns.truth()})
    if (!truth.empty()) session.check_output(truth);
}

void run(SimulateArguments& arguments, Session& session) {
  if (are_many_scenes(arguments.scenes)) return simulate_set(arguments, session);
  check_is_of_one_scene(arguments);
  arguments.scene.scene = arguments.scenes.front();
  const Camera camera = arguments.camera.load();
  const CodeSet code = load_played_code(arguments.code, camera, arguments.taps.file_options());
  check_outputs(arguments, session);
  const LoadedScene scene = load_scene(arguments.scene, camera);
  const SceneLight light = arguments.returns.load(scene, camera);
  const OperatingPoint middle = camera.operating.middle();
  arguments.options.signal_e_per_s = arguments.signal_e_per_s.value_or(middle.signal_e_per_s);
  arguments.options.ambient_e_per_s = arguments.ambient_e_per_s.value_or(middle.ambient_e_per_s);
  const RawFrames raw =
      capture(scene.image, light, code, camera, arguments.options, terminal_progress("capturing"));
  write_raw_frames(arguments.output, raw, session.output_policy());
  if (!arguments.truth.empty())
    write_depth(arguments.truth, scene.image.depth_m, session.output_policy());
  if (!arguments.returns.truth().empty())
    write_returns_truth(arguments.returns.truth(),
                        returns_truth(scene.image, light, arguments.options), light,
                        session.output_policy());
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
                      {"lens",
                       {{"fx_px", scene.view.fx_px},
                        {"fy_px", scene.view.fy_px},
                        {"cx_px", scene.view.cx_px},
                        {"cy_px", scene.view.cy_px}}},
                      {"output", arguments.output}});
  session.say(fmt::format(
      "wrote {}: {} frame{} of {} x {} pixels, {} measurements of {} (S = {:.4g} e/s at {:.3g} m, "
      "A = {:.4g} e/s, seed {})",
      arguments.output, raw.frames, raw.frames == 1 ? "" : "s", raw.height, raw.width,
      raw.measurements, code.name(), arguments.options.signal_e_per_s,
      arguments.options.reference_distance_m, arguments.options.ambient_e_per_s,
      arguments.options.seed));
  if (extent.beyond_range > 0) session.say(beyond_range_remark(extent));
  if (!(lens_setting(scene.view) ==
        lens_setting(view_of(camera.lens, scene.image.width(), scene.image.height()))))
    session.say(fmt::format("to decode it as points or z-depth, say how it was seen: --set '{}'",
                            lens_setting(scene.view)));
}

}  // namespace

void add_simulate_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand("simulate", "raw measurements of a scene, or of many");
  command
      ->add_option("SCENE", arguments->scenes,
                   std::string(scene_help) + "; many: a folder, a list (.txt) or several")
      ->required();
  arguments->scene.add_to(*command);
  command->add_option("--code", arguments->code, "a family or a code file")->required();
  arguments->camera.add_to(*command);
  arguments->taps.add_to(*command);
  command->add_option(
      "--signal", arguments->signal_e_per_s,
      "signal of albedo 1 at the reference distance [e/s] (middle of the camera's)");
  command->add_option("--ambient", arguments->ambient_e_per_s,
                      "ambient light [e/s] (middle of the camera's)");
  command->add_option("--signal-range", arguments->signal_range,
                      "a:b, of many scenes: draw --signal of each log-uniformly");
  command->add_option("--ambient-range", arguments->ambient_range,
                      "a:b, of many scenes: draw --ambient of each log-uniformly");
  command->add_option("--shard", arguments->shard,
                      "i/n, of many scenes: only the i-th of n parts, into the same directory");
  command
      ->add_option("--reference-distance", arguments->options.reference_distance_m,
                   "where the signal is as given [m]")
      ->check(positive_number())
      ->capture_default_str();
  command->add_flag("!--no-falloff", arguments->options.falloff,
                    "signal depends on albedo only, not on distance and angle");
  command->add_option("--frames", arguments->options.frames, "independent frames")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "seed of all noise")
      ->capture_default_str();
  command
      ->add_option("-o,--output", arguments->output,
                   "raw frames (.npy .npz); of many scenes a directory")
      ->required();
  command->add_option("--truth", arguments->truth, "also write the true radial distance");
  arguments->returns.add_to(*command);
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
