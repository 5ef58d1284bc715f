// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tofsmith::apps {

/// Group of options that `--help` leaves out and `--help-all` shows: `->group(for_experts)` where
/// an option is declared. Of the others a command has about fifteen, which a test counts.
inline constexpr const char* for_experts = "For experts";

/// What `--help` and `--help-all` print.
class HelpPages : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace tofsmith::apps
