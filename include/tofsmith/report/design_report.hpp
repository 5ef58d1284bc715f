// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tofsmith/design/design.hpp"
#include "tofsmith/io/result_document.hpp"
#include "tofsmith/io/scene_toml.hpp"
#include "tofsmith/report/page.hpp"
#include "tofsmith/simulate/multipath_error.hpp"
#include "tofsmith/simulate/robustness.hpp"
#include "tofsmith/simulate/scene_result.hpp"

namespace tofsmith {

/// Report of a design. The first screen contains the best code and the standard codes, error versus
/// light, waveforms, a scene before and after, files and commands; sections with all candidates,
/// maps, waveforms, coding curves, convergence and the scene are folded.
/// @param command_line  command to show on the page; may be empty
/// @param files  names in the directory of the report to link to; may be empty
Page design_report(const Camera& camera, const DesignResult& result,
                   const std::optional<SceneResult>& scene, const std::string& command_line,
                   const std::vector<std::string>& files = {});

/// As above for a directory that contains a design.
Page design_report(const DesignedDirectory& found, const std::string& command_line);

/// Report of codes evaluated on a camera, including zncc errors for the same trials and errors on
/// perturbed cameras if they were computed.
Page evaluation_report(const Camera& camera, const std::vector<CodeSet>& codes,
                       std::span<const EvaluatedCode> evaluated, const std::string& command_line);

/// Describes the codes that find_requirements() tried, and whether others may need less.
std::string searched_codes_text(const RequirementOptions& options);

/// Rows of the table of changes that reach a target error, headings first.
std::vector<std::vector<std::string>> requirement_rows(const Camera& camera,
                                                       const Requirements& found,
                                                       const RequirementOptions& options);

/// As above as a page, with a map of the error over bandwidth and power.
Page requirements_report(const Camera& camera, const Requirements& found,
                         const RequirementOptions& options, const std::string& command_line);

/// A code and its depth error on perturbed cameras.
struct JudgedCode {
  std::string name;
  RobustnessReport robustness;
};

/// Returns the codes that were evaluated on perturbed cameras.
std::vector<JudgedCode> judged_codes(std::span<const EvaluatedCode> codes);

/// Rows of the robustness table, headings first: every code on every perturbed camera, each error
/// with its ratio to the nominal error, and the worst case.
std::vector<std::vector<std::string>> robustness_rows(const std::vector<JudgedCode>& codes);

/// As above as a section.
Section robustness_section(const std::vector<JudgedCode>& codes);

/// Returns true if codes were also decoded by zncc.
bool is_compared_with_zncc(std::span<const EvaluatedCode> codes);

/// Rows of a table that compares zncc with maximum likelihood on the same trials, headings first:
/// zncc errors and error ratios, as geometric means and optionally at every light level.
std::vector<std::vector<std::string>> zncc_comparison_rows(std::span<const EvaluatedCode> codes,
                                                           bool every_level);
/// As above as a section.
Section zncc_comparison(std::span<const EvaluatedCode> codes);

/// Rows of the table of multipath errors, headings first: every code at every signal, with single
/// returns, second returns and tails.
std::vector<std::vector<std::string>> multipath_rows(
    const std::vector<MultipathErrorReport>& codes);

/// Heat maps over (delta, r) of bias and error, single-path next to two-return with their bound,
/// one panel per code and signal; and the table.
Section multipath_section(const std::vector<MultipathErrorReport>& codes);

/// Rows of the table of errors by mean delay of the multipath light, headings first.
std::vector<std::vector<std::string>> multipath_scene_rows(const MultipathScene& scene);

/// True, single-path and two-return depth with errors, a map of detected second returns, the middle
/// row seen from above, point clouds of both decoders, and the table.
Section multipath_scene_section(const MultipathScene& scene, const Camera& camera);

}  // namespace tofsmith
