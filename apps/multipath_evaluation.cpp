// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include "multipath_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "number_checks.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/design_report.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith::apps {

void MultipathEvaluation::add_to(CLI::App& command) {
  CLI::Option* multipath = command.add_flag(
      "--multipath", asked_,
      "instead: bias and error of direct depth behind a second return or a tail, single-path "
      "against two-return decoding, with the Cramer-Rao bound");
  const auto list = [&](const char* name, std::vector<double>& values, const char* help) {
    command.add_option(name, values, help)->delimiter(',')->capture_default_str()->needs(multipath);
  };
  list("--delays", options_.delay_m, "delays of the second return [m]");
  list("--ratios", options_.ratio, "its ratios to the direct one");
  list("--tails", options_.tail_m, "mean delays of tails [m]");
  list("--signals", options_.signal_e_per_s, "signals of the direct return [e/s]");
  command.add_option("--multipath-ambient", options_.ambient_e_per_s, "ambient light [e/s]")
      ->capture_default_str()
      ->needs(multipath);
  command
      .add_option("--threshold", options_.decoding.threshold,
                  "how much chi^2 must fall for a second return to count")
      ->check(number_from_0_on())
      ->capture_default_str()
      ->needs(multipath);
  CLI::Option* scene =
      command
          .add_option("--scene", scene_.scene,
                      "also a scene whose surfaces light each other, decoded by the first code at "
                      "the highest of --signals: built-in (see `tofsmith scene`), scene file "
                      "(.toml) or mesh")
          ->needs(multipath);
  command.add_option("--width", scene_.width, "columns of a built-in scene or a mesh (320)")
      ->check(CLI::Range(1, 16384))
      ->needs(scene);
  command.add_option("--height", scene_.height, "rows of a built-in scene or a mesh (240)")
      ->check(CLI::Range(1, 16384))
      ->needs(scene);
  command
      .add_option("--bounce-rays", bounce_.rays, "rays by which each pixel gathers bounced light")
      ->check(CLI::Range(16, 65536))
      ->capture_default_str()
      ->needs(scene);
}

std::optional<MultipathScene> MultipathEvaluation::scene(
    const std::vector<CodeSet>& codes, const Camera& camera,
    const MultipathErrorOptions& options) const {
  if (scene_.scene.empty()) return std::nullopt;
  const LoadedScene loaded = scene_of(scene_, camera);
  const MultipathReturns returns =
      bounced_light_of(loaded, camera, bounce_, terminal_progress("gathering light"));
  const CaptureOptions light{.signal_e_per_s = std::ranges::max(options.signal_e_per_s),
                             .ambient_e_per_s = options.ambient_e_per_s,
                             .reference_distance_m = median_depth_m(loaded.image),
                             .seed = options.seed};
  return multipath_scene(loaded.name, loaded.image, loaded.view, returns, codes.front(), camera,
                         light, options.decoding, terminal_progress("decoding the scene"));
}

void MultipathEvaluation::run(const std::vector<CodeSet>& codes, const Camera& camera,
                              std::int64_t trials, std::uint64_t seed, const std::string& output,
                              const Session& session) const {
  MultipathErrorOptions options = options_;
  if (trials > 0) options.trials = trials;
  options.seed = seed;
  options.validate(camera.range_m());
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".csv")
    throw UsageError(
        fmt::format("-o {}: found .csv; expected .json or .html with --multipath", output));
  const std::optional<MultipathScene> lit = scene(codes, camera, options);
  const MultipathScene* lit_scene = lit ? &*lit : nullptr;
  std::vector<MultipathErrorReport> reports;
  const ProgressParts parts(terminal_progress("evaluating"), codes.size());
  for (std::size_t i = 0; i < codes.size(); ++i)
    reports.push_back(multipath_error(codes[i], camera, options, parts[i]));
  if (extension == ".json")
    write_file_atomically(output, multipath_document(camera, reports, options, lit_scene) + "\n",
                          session.output_policy());
  if (extension == ".html") {
    Page page{.title = "Where light comes back twice",
              .subtitle = "camera " + camera.name,
              .sections = {multipath_section(reports)},
              .footer = fmt::format("{} trials per place, seed {}", options.trials, seed)};
    if (lit) page.sections.push_back(multipath_scene_section(*lit, camera));
    write_file_atomically(output, render(page), session.output_policy());
  }
  if (session.json)
    return session.print_document(multipath_document(camera, reports, options, lit_scene));
  session.say(text_table(multipath_rows(reports)));
  if (lit) session.say(text_table(multipath_scene_rows(*lit)));
  for (const MultipathErrorReport& report : reports)
    if (!report.why_no_two_returns.empty())
      session.say(
          fmt::format("{}: no two-return decoding: {}", report.code, report.why_no_two_returns));
  session.say(fmt::format(
      "{} trials per place, seed {}, A = {:.3g} e/s, N = {}; 1: single-path, 2: two returns or "
      "tail; gain: error 1 over error 2",
      options.trials, seed, options.ambient_e_per_s, camera.samples));
}

}  // namespace tofsmith::apps
