// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene_source.hpp"
#include "tofsmith/sweep/training_set.hpp"

namespace tofsmith::apps {

/// What `simulate` makes of many scenes.
struct TrainingSetRequest {
  std::vector<std::string> scenes;  ///< folders, lists (.txt) and files
  SceneSource source;               ///< how each is to be read
  std::filesystem::path directory;
  TrainingSetOptions options;
};

/// Whether that is more than one scene.
bool are_many_scenes(const std::vector<std::string>& scenes);

/// @param what   "signal" or "ambient"
/// @param range  "a:b", or "" for a fixed level
/// @param level  that the user gave; else `usual`
/// @throws UsageError if the range is none, or there is a level beside it
LightRange light_range(const std::string& what, const std::string& range,
                       std::optional<double> level, double usual);

/// Writes and tells. @throws as write_training_set(); std::runtime_error if some scenes failed
void make_training_set(const TrainingSetRequest& request, const CodeSet& code, const Camera& camera,
                       Session& session);

}  // namespace tofsmith::apps
