// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "commands.hpp"
#include "python_module.hpp"
#include "session.hpp"

namespace tofsmith::apps {

namespace {

struct ReproduceArguments {
  std::vector<std::string> figures;
  bool fast = false;
  std::uint64_t seed = 1;
  std::string mesh;
  std::string output = "tofsmith-reproduce";
};

std::vector<std::string> python_arguments(const ReproduceArguments& arguments,
                                          const Session& session) {
  std::vector<std::string> words = {"--output=" + arguments.output,
                                    "--seed=" + std::to_string(arguments.seed),
                                    "--threads=" + std::to_string(session.threads)};
  if (!arguments.mesh.empty()) words.push_back("--mesh=" + arguments.mesh);
  if (arguments.fast) words.emplace_back("--fast");
  if (session.force) words.emplace_back("--force");
  if (session.json) words.emplace_back("--json");
  words.emplace_back("--");
  words.insert(words.end(), arguments.figures.begin(), arguments.figures.end());
  return words;
}

}  // namespace

void add_reproduce_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* command = app.add_subcommand(
      "reproduce",
      "reproduce figures and statements of Gutierrez-Barragan et al., CVPR 2019 (runs python3 "
      "-m tofsmith.paper)");
  command
      ->add_option("FIGURE", arguments->figures,
                   "one or several of: all, fig2 to fig11, table1, text")
      ->required();
  command->add_flag("--fast", arguments->fast, "faster, with larger statistical errors");
  command->add_option("--seed", arguments->seed, "seed of every random choice")
      ->capture_default_str();
  command->add_option("--mesh", arguments->mesh,
                      "mesh for fig7, instead of the modelled hand (.obj .ply .stl, of any size)");
  command
      ->add_option("-o,--output", arguments->output,
                   "output directory; finished figures are computed again only with --force")
      ->capture_default_str();
  command->callback([arguments, &session] {
    run_python_module("tofsmith.paper", "", python_arguments(*arguments, session));
  });
}

}  // namespace tofsmith::apps
