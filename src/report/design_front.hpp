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

/// First screen of the report of a design: the best code and standard codes, error versus light,
/// waveforms, a scene, and the files with commands.
/// @param files  names in the directory of the report
Section design_front(const Camera& camera, const DesignResult& result,
                     const std::optional<SceneResult>& scene,
                     const std::vector<std::string>& files);

/// Targets (N, K) of a candidate, rotated to its origin of depth; empty without target.
Eigen::MatrixXd rotated_target(const Candidate& candidate);

}  // namespace tofsmith
