// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "session.hpp"
#include "tofsmith/design/optimize.hpp"

namespace tofsmith::apps {

/// Second returns that designed codes shall stand: `--second-returns`, `--second-return-weight`.
class SecondReturnArguments {
 public:
  void add_to(CLI::App& command);
  /// None if they were not asked for.
  /// @throws UsageError for what cannot be read; std::invalid_argument as SecondReturnGoal
  std::optional<SecondReturnGoal> goal(const Camera& camera) const;

 private:
  std::string returns_;
  double weight_ = SecondReturnGoal().weight;
};

}  // namespace tofsmith::apps
