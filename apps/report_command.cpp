// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "session.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/report/design_report.hpp"

namespace tofsmith::apps {

namespace {

struct ReportArguments {
  std::string directory;
  std::string output;
};

void run(const ReportArguments& arguments, const Session& session) {
  const std::filesystem::path directory = arguments.directory;
  const DesignedDirectory found = read_designed_directory(directory);
  const std::filesystem::path output = arguments.output.empty()
                                           ? directory / "report.html"
                                           : std::filesystem::path(arguments.output);
  session.check_output(output);
  if (interrupted()) throw Interrupted();
  write_file_atomically(output, render(design_report(found, session.command_line)),
                        session.output_policy());
  session.print_json({{"directory", directory.string()},
                      {"camera", found.design.camera.name},
                      {"best", found.design.result.winner().code.name()},
                      {"scene", found.scene.has_value()},
                      {"output", output.string()}});
  session.say(fmt::format("wrote {}", output.string()));
}

}  // namespace

void add_report_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command =
      app.add_subcommand("report", "build the report page of a design or demo directory");
  command->add_option("DIR", arguments->directory, "output directory of design or demo")
      ->required();
  command->add_option("-o,--output", arguments->output, "HTML file (default: DIR/report.html)");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace tofsmith::apps
