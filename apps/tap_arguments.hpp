// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "help_pages.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::apps {

/// Returns a validator that accepts one of these words and suggests similar words for others.
inline CLI::Validator one_of(const std::vector<std::string>& words) {
  const CLI::Validator member = CLI::IsMember(words);
  CLI::Validator check = member;
  return check.operation([member, words](std::string& word) {
    std::string problem = member(word);
    if (problem.empty()) return problem;
    const std::string near = nearest_word(word, words);
    return near.empty() ? problem : problem + "; did you mean " + near + "?";
  });
}

/// Options for the columns of NPZ codes with several taps: `--taps`, `--tap-order`.
struct TapArguments {
  std::optional<int> taps;
  std::string order;

  void add_to(CLI::App& command) {
    command.add_option("--taps", taps, "number of taps of an NPZ code (default: the camera's)")
        ->group(for_experts);
    command
        .add_option("--tap-order", order,
                    "column order of an NPZ code with several taps: all exposures of the first "
                    "tap first (blocked), or all taps of the first exposure first "
                    "(interleaved); not detected")
        ->check(one_of({"blocked", "interleaved"}))
        ->group(for_experts);
  }
  std::optional<TapOrder> tap_order() const {
    return order.empty() ? std::nullopt : std::optional(parse_tap_order(order));
  }
  CodeFileOptions file_options() const { return {.taps = taps, .tap_order = tap_order()}; }
};

}  // namespace tofsmith::apps
