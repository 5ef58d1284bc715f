// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "help_pages.hpp"
#include "session.hpp"
#include "tofsmith/core/error.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

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
                    "column order of an NPZ code: all exposures of the first tap first (blocked), "
                    "or all taps of the first exposure first (interleaved); required for several "
                    "taps and several exposures")
        ->check(one_of({"blocked", "interleaved"}))
        ->group(for_experts);
  }
  std::optional<TapOrder> tap_order() const {
    return order.empty() ? std::nullopt : std::optional(parse_tap_order(order));
  }
  CodeFileOptions file_options() const { return {.taps = taps, .tap_order = tap_order()}; }
  /// As file_options(), for the codes of a command.
  /// @throws UsageError if an option is given and no code is an array
  CodeFileOptions file_options_for(const std::vector<std::string>& codes) const {
    const bool reads_columns = std::ranges::any_of(codes, [](const std::string& code) {
      return code.ends_with(".npz") || code.ends_with(".npy") || names_measured_table(code);
    });
    if ((taps || !order.empty()) && !reads_columns)
      throw UsageError(fmt::format(
          "{}: found the code {}; expected an array (.npz){}", taps ? "--taps" : "--tap-order",
          fmt::join(codes, ", "),
          taps ? fmt::format("; --set sensor.taps={} sets the taps of the camera", *taps) : ""));
    return file_options();
  }
};

}  // namespace tofsmith::apps
