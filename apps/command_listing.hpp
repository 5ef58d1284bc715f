// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

namespace tofsmith::apps {

/// Every command with its arguments, as the command line itself knows them; manual pages and shell
/// completion are made from it.
///   {"version": "0.1.0",
///    "names": {"camera": ["paper-10f0", ..], "code": [..], "scene": [..]},    built-in ones
///    "commands": [{"words": ["calibrate", "noise"], "summary", "example", "subcommands": [..],
///                  "positionals": [argument, ..], "options": [argument, ..]}, ..]}
/// The first command has no words: it is the program itself, whose options hold everywhere. An
/// argument is {"names": ["-o", "--output"], "help", "needs": [..], "excludes": [..], "value":
/// "TEXT", "default", "choices": [..], "required", "many"}; a flag has no "value".
nlohmann::ordered_json command_listing(const CLI::App& app);

}  // namespace tofsmith::apps
