// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene_source.hpp"
#include "session.hpp"
#include "tofsmith/scene/bounced_light.hpp"
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
  /// What becomes of the scene by the first code; none if there is no scene.
  std::optional<MultipathScene> scene(const std::vector<CodeSet>& codes, const Camera& camera,
                                      const MultipathErrorOptions& options) const;

  SceneSource scene_;
  BounceOptions bounce_;
  MultipathErrorOptions options_;
};

}  // namespace tofsmith::apps
