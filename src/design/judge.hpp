// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Codes and origins are chosen by other random numbers than they are judged by. The judge's are
/// those of evaluate() with the same seed.
std::uint64_t search_seed(const DesignOptions& options);

/// Whether candidates are moved to their best origin. The circular error does not depend on it,
/// unless the camera weighs depths.
bool rotates(const Camera& camera, const DesignOptions& options);

/// Why no depth can be decoded with a code: the camera cannot play it, or what it measures does not
/// distinguish depths. None: depth can be decoded.
std::optional<std::string> why_no_depth(const CodeSet& code, const Camera& camera);

/// @throws std::invalid_argument for bad options or camera, or if together they ask for codes that
///         are robust and take multipath into account
void require_judgeable(const Camera& camera, const DesignOptions& options);

/// What judge() does, for checked options: leaves out candidates that tell no depth, judges the
/// others, keeps the best of each name and finds the winner.
/// @throws std::invalid_argument if no candidate is left; Interrupted
void judge_candidates(const Camera& camera, const DesignOptions& options, DesignResult& result,
                      const Progress& progress);

}  // namespace tofsmith
