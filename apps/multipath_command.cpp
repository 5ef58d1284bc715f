// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "described_options.hpp"
#include "help_pages.hpp"
#include "number_checks.hpp"
#include "scene_source.hpp"
#include "session.hpp"
#include "tap_arguments.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/decoding_table_file.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/scene/bounced_light.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::apps {
namespace {

struct MultipathCommandArguments {
  std::vector<std::string> codes;
  CameraArguments camera;
  MultipathErrorOptions options;
  SceneSource scene;
  BounceOptions bounce;
  TapArguments taps;
  std::string output;
};

/// Captures and decodes the scene with the first code; returns none without a scene.
std::optional<MultipathScene> lit_scene(const MultipathCommandArguments& arguments,
                                        const std::vector<CodeSet>& codes, const Camera& camera) {
  if (arguments.scene.scene.empty()) return std::nullopt;
  const MultipathErrorOptions& options = arguments.options;
  const LoadedScene loaded = scene_of(arguments.scene, camera);
  const MultipathReturns returns =
      bounced_light_of(loaded, camera, arguments.bounce, terminal_progress("gathering light"));
  const CaptureOptions light{.signal_e_per_s = std::ranges::max(options.signal_e_per_s),
                             .ambient_e_per_s = options.ambient_e_per_s,
                             .reference_distance_m = median_depth_m(loaded.image),
                             .seed = options.seed};
  return multipath_scene(loaded.name, loaded.image, loaded.view, returns, codes.front(), camera,
                         light, options.decoding, terminal_progress("decoding the scene"));
}

Page multipath_page(const Camera& camera, const std::vector<MultipathErrorReport>& reports,
                    const MultipathErrorOptions& options, const MultipathScene* scene) {
  Page page{.title = "Depth error with multipath",
            .subtitle = "camera " + camera.name,
            .sections = {multipath_section(reports)},
            .footer = fmt::format("{} trials per cell, seed {}", options.trials, options.seed)};
  if (scene) page.sections.push_back(multipath_scene_section(*scene, camera));
  return page;
}

void print(const Session& session, const Camera& camera,
           const std::vector<MultipathErrorReport>& reports, const MultipathErrorOptions& options,
           const MultipathScene* scene) {
  if (session.json)
    return session.print_document(multipath_document(camera, reports, options, scene));
  session.say(text_table(multipath_rows(reports)));
  if (scene) session.say(text_table(multipath_scene_rows(*scene)));
  for (const MultipathErrorReport& report : reports)
    if (!report.why_no_two_returns.empty())
      session.say(fmt::format("{}: two-return decoding is not possible: {}", report.code,
                              report.why_no_two_returns));
  session.say(
      fmt::format("{} trials per cell, seed {}, A = {:.3g} e/s, N = {}; 1: single-path decoding, "
                  "2: two-return or tail decoding; gain: error 1 / error 2",
                  options.trials, options.seed, options.ambient_e_per_s, camera.samples));
}

void run(const MultipathCommandArguments& arguments, const Session& session) {
  const Camera camera = arguments.camera.load();
  const MultipathErrorOptions& options = arguments.options;
  options.validate(camera.range_m());
  const std::string& output = arguments.output;
  const std::string extension = std::filesystem::path(output).extension().string();
  if (!output.empty()) {
    if (extension != ".json" && extension != ".html")
      throw UsageError(fmt::format("-o {}: unknown extension; expected .json or .html", output));
    session.check_output(output);
  }
  const CodeFileOptions file_options = arguments.taps.file_for(arguments.codes);
  std::vector<CodeSet> codes;
  for (const std::string& name : arguments.codes)
    codes.push_back(load_camera_code(name, camera, file_options));
  const std::optional<MultipathScene> lit = lit_scene(arguments, codes, camera);
  const MultipathScene* scene = lit ? &*lit : nullptr;
  std::vector<MultipathErrorReport> reports;
  const ProgressParts parts(terminal_progress("evaluating"), codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i)
    reports.push_back(multipath_error(codes[i], camera, options, parts[i]));
  if (extension == ".json")
    write_file_atomically(output, multipath_document(camera, reports, options, scene) + "\n",
                          session.output_policy());
  if (extension == ".html")
    write_file_atomically(output, render(multipath_page(camera, reports, options, scene)),
                          session.output_policy());
  print(session, camera, reports, options, scene);
}

void add_scene(CLI::App& command, MultipathCommandArguments& arguments) {
  CLI::Option* scene =
      command.add_option("--scene", arguments.scene.scene,
                         "also evaluate a scene with light reflected between its surfaces: "
                         "built-in scene (see `tofsmith scene`), scene file (.toml) or mesh; "
                         "uses the first CODE and the highest of --signals");
  add_field_option(command, arguments.scene, "width")->needs(scene);
  add_field_option(command, arguments.scene, "height")->needs(scene);
  add_field_option(command, arguments.bounce, "rays", "--bounce-rays")
      ->needs(scene)
      ->group(for_experts);
}

}  // namespace

void add_multipath_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<MultipathCommandArguments>();
  MultipathErrorOptions& options = arguments->options;
  CLI::App* command =
      app.add_subcommand("multipath",
                         "evaluate codes under multipath: bias and error with a second return or "
                         "an exponential tail, for single-path and two-return decoding");
  command->add_option("CODE", arguments->codes, "families or code files (.code.json .npz .csv)")
      ->required();
  arguments->camera.add_to(*command);
  const FieldOptions fields(*command, options);
  fields.add("delay_m", "--delays");
  fields.add("ratio", "--ratios");
  fields.add("tail_m", "--tails");
  fields.add("signal_e_per_s", "--signals");
  fields.add("ambient_e_per_s", "--ambient");
  add_field_option(*command, options.decoding, "threshold")->group(for_experts);
  fields.add("trials");
  fields.add("seed");
  add_scene(*command, *arguments);
  arguments->taps.add_to(*command);
  command->add_option("-o,--output", arguments->output,
                      "write all results (.json) or a page (.html)");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
