// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulate/shared/code_on_camera.hpp"
#include "tofsmith/design/candidate.hpp"
#include "tofsmith/design/design.hpp"

namespace tofsmith {

CodeSet signed_by(CodeSet code, const std::string& method, const Camera& camera,
                  std::uint64_t seed);

std::vector<MeasurementReport> reports_of(const CodeSet& code, const std::string& start);

/// Seed for choosing codes and origins; judge() uses DesignOptions::seed.
std::uint64_t search_seed(const DesignOptions& options);

/// False for the circular error without weighted depths, which does not depend on the origin.
bool rotates(const Camera& camera, const DesignOptions& options);

/// Returns why the camera cannot measure depth with a code, or nothing.
std::optional<std::string> why_no_depth(const CodeSet& code, const Camera& camera);

/// Returns nothing if why_no_depth() has a reason. `code` must outlive the result.
std::optional<CodeOnCamera> if_it_has_depth(const CodeSet& code, const Camera& camera);

/// @throws std::invalid_argument for invalid options or camera, or robust codes with
///   operating.multipath or operating.interference
void require_judgeable(const Camera& camera, const DesignOptions& options);

/// As judge() with validated options.
/// @throws std::invalid_argument if no candidate is left; Interrupted
void judge_candidates(const Camera& camera, const DesignOptions& options, DesignResult& result,
                      const Progress& progress);

/// Explains the winner: its lead, its number of exposures, and the limits of its error in dim and
/// in bright light.
/// @param exposures  requested numbers; empty: any
std::vector<std::string> explain(const Camera& camera, const DesignResult& result,
                                 const std::vector<int>& exposures = {});

}  // namespace tofsmith
