// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "described_options.hpp"
#include "help_pages.hpp"
#include "session.hpp"
#include "tofsmith/io/code_file.hpp"
#include "tofsmith/io/decoding_table_file.hpp"

namespace tofsmith::apps {

/// Options for the columns of NPZ codes with several taps: `--taps`, `--tap-order`.
struct TapArguments {
  CodeFileOptions file;

  void add_to(CLI::App& command) {
    const FieldOptions fields(command, file);
    fields.add("taps")->group(for_experts);
    fields.add("tap_order")->group(for_experts);
  }
  /// Returns the options for the codes of a command.
  /// @throws UsageError if an option is given and no code is an array
  const CodeFileOptions& file_for(const std::vector<std::string>& codes) const {
    const bool reads_columns = std::ranges::any_of(codes, [](const std::string& code) {
      return code.ends_with(".npz") || code.ends_with(".npy") || names_measured_table(code);
    });
    const auto& taps = file.taps;
    if ((taps || file.tap_order) && !reads_columns)
      throw UsageError(fmt::format(
          "{}: found the code {}; expected an array (.npz){}", taps ? "--taps" : "--tap-order",
          fmt::join(codes, ", "),
          taps ? fmt::format("; --set sensor.taps={} sets the taps of the camera", *taps) : ""));
    return file;
  }
};

}  // namespace tofsmith::apps
