// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tofsmith::apps {

/// Group of options that only `--help-all` shows: declare them with `->group(for_experts)`. A test
/// limits the number of all other options to about fifteen per command.
inline constexpr const char* for_experts = "For experts";

/// Formatter of `--help` and `--help-all`: options in sections by task, wrapped to the terminal.
class HelpPages : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Adds examples to the footers of commands.
void add_examples(CLI::App& app);

/// Returns the names of an option with their dashes: "-o", "--output". Positionals have none.
std::vector<std::string> dashed_names(const CLI::Option& option);

/// Returns the names of a command and its parents, such as " calibrate noise".
std::string command_words(const CLI::App& command);

/// Returns all commands with their arguments, for manual pages and shell completion.
///   {"version": "0.1.0",
///    "names": {"camera": ["paper-10f0", ...], "code": [...], "scene": [...]},    built-in ones
///    "commands": [{"words": ["calibrate", "noise"], "summary", "example", "subcommands": [...],
///                  "positionals": [argument, ...], "options": [argument, ...]}, ...]}
/// The first command has no words: it is the program, whose options apply to all commands. An
/// argument is {"names": ["-o", "--output"], "help", "needs": [...], "excludes": [...], "value":
/// "TEXT", "default", "choices": [...], "required", "many"}; flags have no "value".
nlohmann::ordered_json command_listing(const CLI::App& app);

}  // namespace tofsmith::apps
