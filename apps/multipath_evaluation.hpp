// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "session.hpp"
#include "tofsmith/simulate/multipath_error.hpp"

namespace tofsmith::apps {

/// `evaluate --multipath`: what codes do where light comes back twice.
class MultipathEvaluation {
 public:
  void add_to(CLI::App& command);
  bool is_asked() const { return asked_; }
  /// @param trials  as of `--trials`; 0: the default of this evaluation
  /// @param output  .json or .html, or empty
  void run(const std::vector<CodeSet>& codes, const Camera& camera, std::int64_t trials,
           std::uint64_t seed, const std::string& output, const Session& session) const;

 private:
  bool asked_ = false;
  MultipathErrorOptions options_;
};

}  // namespace tofsmith::apps
