// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// The first screen of the report of a design: the best code and the standard codes it beats, its
/// error over light, its waveforms, a scene before and after, the files and commands that use them.
/// @param files  names in the directory of the report
Section design_front(const Camera& camera, const DesignResult& result,
                     const std::optional<SceneResult>& scene,
                     const std::vector<std::string>& files);

/// The correlation functions (N, K) for which a candidate was designed, rotated to its origin of
/// depth; empty if it has no target.
Eigen::MatrixXd rotated_target(const Candidate& candidate);

}  // namespace tofsmith
