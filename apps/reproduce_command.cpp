// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>

#include "commands.hpp"
#include "fresh_directory.hpp"
#include "paper/reproduction_directory.hpp"
#include "session.hpp"
#include "terminal_progress.hpp"
#include "tofsmith/io/mesh_file.hpp"

namespace tofsmith::apps {

namespace {

struct ReproduceArguments {
  std::vector<std::string> names;
  ReproduceOptions options;
  std::string mesh;
  std::string output = "tofsmith-reproduce";
};

std::vector<const PaperItem*> chosen_items(const std::vector<std::string>& names) {
  try {
    return paper_items_named(names);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

void run(ReproduceArguments& arguments, const Session& session) {
  const std::vector<const PaperItem*> items = chosen_items(arguments.names);
  if (!arguments.mesh.empty()) {
    if (std::ranges::none_of(items, [](const PaperItem* item) { return item->shows_mesh; }))
      throw UsageError("--mesh: only fig7 shows a mesh");
    arguments.options.mesh = read_mesh(arguments.mesh);
    arguments.options.mesh_name = std::filesystem::path(arguments.mesh).filename().string();
  }
  const ReproductionDirectory directory(arguments.output);
  const FreshDirectory cleanup(directory.path());
  const std::vector<ReproducedItem> reproduced = reproduce(
      directory, items, arguments.options, session.force, terminal_progress("reproducing"));

  nlohmann::ordered_json documents = nlohmann::ordered_json::array();
  std::vector<std::string> lines;
  for (const auto& [item, findings, kept] : reproduced) {
    lines.push_back(fmt::format("{}: {}: {}{}", item->name, item->title,
                                name_of(overall_verdict(findings)),
                                kept ? " (finished before)" : ""));
    nlohmann::ordered_json statements = nlohmann::ordered_json::array();
    for (const CheckedStatement& finding : findings) {
      lines.push_back(fmt::format("  {}: {}\n    {}", name_of(finding.verdict), finding.statement,
                                  finding.measured));
      statements.push_back({{"verdict", name_of(finding.verdict)},
                            {"statement", finding.statement},
                            {"measured", finding.measured},
                            {"why", finding.why}});
    }
    documents.push_back(
        {{"name", item->name}, {"title", item->title}, {"findings", std::move(statements)}});
  }
  session.print_json({{"seed", arguments.options.seed},
                      {"fast", arguments.options.fast},
                      {"output", (directory.path() / "index.html").string()},
                      {"items", std::move(documents)}});
  for (const std::string& line : lines) session.say(line);
  session.say(fmt::format("report: {}", (directory.path() / "index.html").string()));
}

}  // namespace

void add_reproduce_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ReproduceArguments>();
  CLI::App* command =
      app.add_subcommand("reproduce", "the paper's figures and statements, with our numbers");
  std::string names = "all";
  for (const PaperItem& item : paper_items()) names += ", " + item.name;
  command->add_option("FIGURE", arguments->names, "one or several of " + names)->required();
  command->add_flag("--fast", arguments->options.fast,
                    "coarse: seconds instead of minutes, larger errors");
  command->add_option("--seed", arguments->options.seed, "seed of every random choice")
      ->capture_default_str();
  command->add_option("--mesh", arguments->mesh,
                      "for fig7, instead of the modelled hand (.obj .ply .stl, of any size)");
  command
      ->add_option("-o,--output", arguments->output,
                   "directory; figures that are finished there are not made again (--force does)")
      ->capture_default_str();
  command->callback([arguments, &session] {
    session.directory = arguments->output;
    run(*arguments, session);
  });
}

}  // namespace tofsmith::apps
