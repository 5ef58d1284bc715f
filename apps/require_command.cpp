// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "described_options.hpp"
#include "distance_arguments.hpp"
#include "fresh_directory.hpp"
#include "method_arguments.hpp"
#include "session.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/units.hpp"
#include "tofsmith/io/design_directory.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith::apps {
namespace {

struct RequireArguments {
  CameraArguments camera;
  DistanceArguments distance;
  RequirementOptions options;
  std::string error;
  std::vector<std::string> vary;
  std::string output;
};

/// Parses "5mm", "2 cm" or "0.005 m".
/// @throws UsageError
double length_of(const std::string& text) {
  const double length_m = number_with_unit(text, "m");
  if (length_m > 0.0 && std::isfinite(length_m)) return length_m;
  throw UsageError(
      fmt::format("--error: found '{}'; expected a length > 0 with its unit, such as 5mm", text));
}

/// Format of the output, by its extension; a directory without extension.
enum class OutputKind { none, numbers, page, directory };

OutputKind kind_of(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (output.empty()) return OutputKind::none;
  if (extension == ".json") return OutputKind::numbers;
  if (extension == ".html") return OutputKind::page;
  if (extension.empty()) return OutputKind::directory;
  throw UsageError(
      fmt::format("-o {}: found {}; expected .json, .html, or a directory", output, extension));
}

/// Checks the outputs before the computation: existing files are only replaced with --force.
OutputPolicy check_outputs(const std::string& output, OutputKind kind, const Session& session) {
  if (kind == OutputKind::none) return session.output_policy();
  if (kind != OutputKind::directory) return session.check_outputs({std::filesystem::path(output)});
  const std::filesystem::path directory(output);
  make_output_directory(directory);
  // In the order of writing. Files of codes that meet the target are written in between.
  return session.check_outputs({directory / "as_it_is.code.json", directory / "requirements.json",
                                directory / "report.html"});
}

void write(const std::string& output, OutputKind kind, const Camera& camera,
           const Requirements& found, const RequirementOptions& options, OutputPolicy policy,
           const Session& session) {
  const auto page = [&](const std::filesystem::path& path) {
    write_file_atomically(
        path, render(requirements_report(camera, found, options, session.command_line)), policy);
  };
  if (kind == OutputKind::numbers)
    write_file_atomically(output, requirements_document(camera, found, options) + "\n", policy);
  if (kind == OutputKind::page) page(output);
  if (kind == OutputKind::directory) {
    write_requirements(output, camera, found, options, policy);
    page(std::filesystem::path(output) / "report.html");
  }
}

void run(RequireArguments& arguments, const Session& session) {
  RequirementOptions& options = arguments.options;
  options.error_m = length_of(arguments.error);
  if (!arguments.vary.empty())
    options.vary_bandwidth = options.vary_power = options.vary_exposure = false;
  for (const std::string& word : arguments.vary) switch (parse_word<CameraQuantity>("vary", word)) {
      case CameraQuantity::bandwidth:
        options.vary_bandwidth = true;
        break;
      case CameraQuantity::power:
        options.vary_power = true;
        break;
      case CameraQuantity::exposure:
        options.vary_exposure = true;
        break;
    }
  const OutputKind kind = kind_of(arguments.output);
  if (kind == OutputKind::none && !session.json) options.map = false;  // part of documents only
  std::optional<FreshDirectory> directory;
  if (kind == OutputKind::directory) directory.emplace(arguments.output);
  const OutputPolicy policy = check_outputs(arguments.output, kind, session);
  const Camera camera = arguments.distance.at(arguments.camera.load(), session);
  const Requirements found = find_requirements(camera, options, terminal_progress("searching"));
  write(arguments.output, kind, camera, found, options, policy, session);
  if (session.json) return session.print_document(requirements_document(camera, found, options));
  session.say(fmt::format("target {}; error now {} with {}{}", length_text(options.error_m),
                          length_text(found.error_m), found.code.name(),
                          found.bound_m > 0.0
                              ? fmt::format(" (bound for any code: {})", length_text(found.bound_m))
                              : std::string()));
  session.say(text_table(requirement_rows(camera, found, options)));
  session.say(fmt::format("one quantity varied at a time; circular error, {} trials, seed {}; {}",
                          options.trials, options.seed, searched_codes_text(options)));
  if (kind == OutputKind::none) return;
  session.say(fmt::format("wrote {}", arguments.output));
  for (const Sufficiency& s : found.varied) {
    if (kind != OutputKind::directory || !s.factor) continue;
    const std::string part =
        (std::filesystem::path(arguments.output) / name_of(s.quantity)).string();
    session.say(
        fmt::format("next: tofsmith evaluate {}.code.json --camera {}.camera.toml", part, part));
    break;
  }
}

}  // namespace

void add_require_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<RequireArguments>();
  CLI::App* command =
      app.add_subcommand("require",
                         "compute the bandwidth, power or exposure that a depth error requires, "
                         "and lower bounds that are valid for all codes");
  arguments->camera.add_to(*command);
  arguments->camera.add_positional(*command);
  command->add_option("--error", arguments->error, "largest acceptable depth error, such as 5mm")
      ->required();
  arguments->distance.add_to(*command);
  command
      ->add_option("--vary", arguments->vary,
                   "quantities to vary, one at a time: bandwidth,power,exposure (default: all "
                   "three)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(one_of<CameraQuantity>());
  const FieldOptions options(*command, arguments->options);
  options.add("max_factor");
  options.add("exact");
  options.add("effort");
  options.add("trials");
  options.add("seed");
  options.add("map", "!--no-map");
  command->add_option("-o,--output", arguments->output,
                      "write a page (.html), all numbers (.json), or a directory with page, "
                      "numbers, and the codes and camera files that have the required error");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
