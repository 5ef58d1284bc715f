// SPDX-FileCopyrightText: 2026 The tofsmith authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tofsmith/design/design.hpp"

namespace tofsmith {

/// Codes and origins are chosen by other random numbers than they are judged by. The judge's are
/// those of evaluate() with the same seed.
std::uint64_t search_seed(const DesignOptions& options);

/// Whether candidates are moved to their best origin. The circular error does not depend on it.
bool rotates(const Camera& camera, const DesignOptions& options);

/// Judges a candidate with random numbers it was not chosen by, at its best origin if asked.
void judge(Candidate& candidate, const Camera& camera, const DesignOptions& options,
           const Progress& progress);

/// Judges it again on the camera's perturbations.
void judge_robustness(Candidate& candidate, const Camera& camera, const DesignOptions& options,
                      const Progress& progress);

}  // namespace tofsmith
