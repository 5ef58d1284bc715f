// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tofsmith/decode/filter.hpp"
#include "tofsmith/decode/time_filter.hpp"

namespace tofsmith::apps {

/// Options for filtering raw measurements: `--filter`, `--filter-set`, `--time-filter`,
/// `--look-ahead`, `--time-filter-set`.
class FilterArguments {
 public:
  void add_to(CLI::App& command);
  /// Returns none without `--filter`.
  /// @throws UsageError for invalid keys or values
  std::optional<FilterOptions> options() const;
  std::optional<TimeFilterOptions> time_options() const;
  std::string name() const { return strength_.empty() ? "off" : strength_; }

 private:
  std::string strength_;
  std::vector<std::string> settings_;
  int max_frames_ = 0;
  TimeFilterOptions time_options_;  ///< without max_frames
  std::vector<std::string> time_settings_;
};

}  // namespace tofsmith::apps
