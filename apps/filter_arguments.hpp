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

/// Whether measurements are filtered before they are decoded: `--filter`, `--filter-set`, and in
/// time `--time-filter`, `--look-ahead`, `--time-filter-set`.
class FilterArguments {
 public:
  void add_to(CLI::App& command);
  /// None without `--filter`. @throws UsageError for a key or a value that cannot be
  std::optional<FilterOptions> options() const;
  /// The same of `--time-filter`.
  std::optional<TimeFilterOptions> time_options() const;
  /// The strength, or "off".
  std::string name() const { return strength_.empty() ? "off" : strength_; }

 private:
  std::string strength_;
  std::vector<std::string> settings_;
  int max_frames_ = 0;
  TimeFilterOptions time_options_;  ///< without max_frames
  std::vector<std::string> time_settings_;
};

}  // namespace tofsmith::apps
