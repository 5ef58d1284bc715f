// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "one_of.hpp"
#include "tofsmith/io/code_file.hpp"

namespace tofsmith::apps {

/// What an NPZ code with several taps does not say about its columns: `--taps`, `--tap-order`.
struct TapArguments {
  std::optional<int> taps;
  std::string order;

  void add_to(CLI::App& command) {
    command.add_option("--taps", taps, "taps of an NPZ code (the camera's)");
    command.add_option("--tap-order", order, "how an NPZ code's columns run; never guessed")
        ->check(one_of({"blocked", "interleaved"}));
  }
  std::optional<TapOrder> tap_order() const {
    return order.empty() ? std::nullopt : std::optional(parse_tap_order(order));
  }
  CodeFileOptions file_options() const { return {.taps = taps, .tap_order = tap_order()}; }
};

}  // namespace tofsmith::apps
