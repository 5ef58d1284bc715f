// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Returns the seed for choosing codes and origins. It differs from the seed of judge(), which uses
/// the same random numbers as evaluate() with DesignOptions::seed.
std::uint64_t search_seed(const DesignOptions& options);

/// Returns true if candidates are moved to their best origin. Without weighted depths, the circular
/// error does not depend on the origin.
bool rotates(const Camera& camera, const DesignOptions& options);

/// Returns why depth cannot be decoded with a code: the camera does not support it, or its
/// measurements do not determine depth. None if it can.
std::optional<std::string> why_no_depth(const CodeSet& code, const Camera& camera);

/// @throws std::invalid_argument for invalid options or camera, or if both robust codes and
///   operating.multipath are requested
void require_judgeable(const Camera& camera, const DesignOptions& options);

/// Implements judge() for validated options: excludes candidates that do not determine depth,
/// evaluates the others, keeps the best of each name and sets the winner.
/// @throws std::invalid_argument if no candidate is left; Interrupted
void judge_candidates(const Camera& camera, const DesignOptions& options, DesignResult& result,
                      const Progress& progress);

}  // namespace tofsmith
