// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/io/scene_directory.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// The report of a design: camera, candidates by depth error, error maps over the operating range,
/// waveforms, coding curves, convergence and, if there is one, the scene.
/// @param command_line  as typed, to be shown on the page; may be empty
Page design_report(const Camera& camera, const DesignResult& result,
                   const std::optional<SceneResult>& scene, const std::string& command_line);

/// The same of a directory that holds a design.
Page design_report(const DesignedDirectory& found, const std::string& command_line);

/// Codes evaluated on a camera, without any design.
Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       const std::vector<DepthErrorReport>& errors,
                       const std::string& command_line);
/// The same, with what zncc makes of the same trials and with perturbed cameras where they have it.
Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       std::span<const EvaluatedCode> evaluated, const std::string& command_line);

}  // namespace tofsmith
