// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

namespace tofsmith::apps {

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
